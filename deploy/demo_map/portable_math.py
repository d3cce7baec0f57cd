"""Arithmetic with the same bits on every machine.

Only + - * / and sqrt are used, which IEEE 754 rounds exactly; the C library's sin, cos and pow differ between systems,
and Python's sum() of floats and hypot() between versions. Angles are in turns (1 turn = 360 degrees).
"""
import functools
import math
import random

MASK_32 = 0xFFFFFFFF


def cos_sin(turns):
    """Cosine and sine: Taylor series of a quarter of the angle, then the angle is doubled twice."""
    quarter = (turns - math.floor(turns + 0.5)) * (math.pi / 2)
    square = quarter * quarter
    sine = cosine = 0.0
    for n in range(16, -1, -2):
        cosine = 1.0 - cosine * square / ((n + 1) * (n + 2))
        sine = 1.0 - sine * square / ((n + 2) * (n + 3))
    sine *= quarter
    for _ in range(2):
        sine, cosine = 2 * sine * cosine, cosine * cosine - sine * sine
    return cosine, sine


def stream(seed, name):
    """A generator of its own for each kind of thing, so that more plants do not move the rocks.

    Call only random() on it: that is the sequence Python promises to keep."""
    return random.Random(f"drtv demo map {seed} {name}")


def between(rng, low, high):
    return low + (high - low) * rng.random()


def random_direction(rng):
    up = between(rng, -1, 1)
    cosine, sine = cos_sin(rng.random())
    radius = math.sqrt(1 - up * up)
    return (radius * cosine, up, radius * sine)


def mix(a, b, share):
    return a + (b - a) * share


def smoothstep(low, high, value):
    t = min(1.0, max(0.0, (value - low) / (high - low)))
    return t * t * (3 - 2 * t)


@functools.lru_cache(maxsize=None)
def lattice(ix, iy, salt):
    """0..1 from two integers: an integer hash."""
    h = (ix * 0x1B873593 + iy * 0x5BD1E995 + salt * 0x3C6EF35F) & MASK_32
    for shift, factor in ((16, 0x45D9F3B), (15, 0x2C9277B5), (13, 0x5851F42D)):
        h = ((h ^ (h >> shift)) * factor) & MASK_32
    return (h ^ (h >> 16)) / 4294967296.0


def noise(x, y, salt):
    """Smooth value noise, 0..1, features about one unit wide."""
    ix, iy = math.floor(x), math.floor(y)
    u, v = x - ix, y - iy
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    south = mix(lattice(ix, iy, salt), lattice(ix + 1, iy, salt), u)
    north = mix(lattice(ix, iy + 1, salt), lattice(ix + 1, iy + 1, salt), u)
    return mix(south, north, v)


def layered_noise(x, y, salt):
    return (4 * noise(x, y, salt) + 2 * noise(2 * x, 2 * y, salt + 1) + noise(4 * x, 4 * y, salt + 2)) / 7


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scaled(a, factor):
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1 / math.sqrt(dot(a, a)))
