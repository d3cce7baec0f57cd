"""drtv_passes once more, in Python's doubles, and pictures to try it on: a step from one wall to another, with noise."""
import json
import math
import os
import random
import struct

MASK_SIZE, SMALL_SIZE = (64, 48), (32, 24)
PIXELS_PER_METRE, SOFT_M = 60.0, 1.0


class Picture:
    def __init__(self, size, texels):
        self.size, self.texels = size, [[as_float(v) for v in texel] for texel in texels]

    def at(self, x, y):
        x, y = (min(max(v, 0), n - 1) for v, n in zip((x, y), self.size))
        return self.texels[x + self.size[0] * y]

    def write(self, path):
        write_floats(path, [v for texel in self.texels for v in texel])


def as_float(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def write_floats(path, values):
    with open(path, "wb") as file:
        file.write(struct.pack(f"<{len(values)}f", *values))


def mask_winding(front, mesh, surface):
    return 0 if mesh < surface else -1 if front else 1


def mask_blur(mask, pixel, axis):
    shown = mask.at(*pixel)[1]
    if shown <= 0:
        return 0, shown
    metres_per_pixel = shown / PIXELS_PER_METRE
    reach = 0.5 * SOFT_M / metres_per_pixel
    radius = (math.floor(reach + 0.5) + 0.5) * metres_per_pixel
    total = count = 0
    for n in range(-8, 9):
        moved = math.floor(n * reach / 8 + 0.5)
        value, metres = mask.at(pixel[0] + axis[0] * moved, pixel[1] + axis[1] * moved)
        if math.hypot(moved * metres_per_pixel, metres - shown) <= radius:
            total, count = total + min(max(value, 0), 1), count + 1
    return total / max(count, 1), shown


def upsampled(ambient, surfaces, at, normal, metres):
    low = [math.floor(v - 0.5) for v in at]
    above = [v - 0.5 - low_v for v, low_v in zip(at, low)]
    total, weights = [0.0] * 3, 0.0
    for y in (0, 1):
        for x in (0, 1):
            texel = surfaces.at(low[0] + x, low[1] + y)
            apart = (texel[3] - metres) / (0.05 * metres)
            turned = max(sum(a * b for a, b in zip(texel, normal)), 0)
            share = (above[0] if x else 1 - above[0]) * (above[1] if y else 1 - above[1])
            weight = share * turned**4 / (1 + apart**4) + 0.0001 / (1 + apart**2)
            light = ambient.at(low[0] + x, low[1] + y)
            total = [sum_ + weight * v for sum_, v in zip(total, light)]
            weights += weight
    return [v / weights for v in total]


def unit(v):
    length = math.hypot(*v)
    return [as_float(x / length) for x in v]


def make_case(folder, count=3000):
    rng = random.Random(5)
    os.makedirs(folder)

    def surface(x, share):  # a near wall on the left, a far one on the right
        near = x < share
        normal = unit(
            [rng.gauss(0, 0.05), rng.gauss(0, 0.05) - 1, 0.1] if near else [1, rng.gauss(0, 0.05), 0.2]
        )
        return [*normal, (10 if near else 25) + rng.uniform(-0.1, 0.1)]

    mask = Picture(
        MASK_SIZE,
        [
            [float(rng.choice([-1, 0, 0, 1, 1, 2])), 0 if rng.random() < 0.02 else surface(x, 30)[3]]
            for _ in range(MASK_SIZE[1])
            for x in range(MASK_SIZE[0])
        ],
    )
    surfaces = Picture(
        SMALL_SIZE, [surface(x, 15) for _ in range(SMALL_SIZE[1]) for x in range(SMALL_SIZE[0])]
    )
    ambient = Picture(SMALL_SIZE, [[rng.uniform(0, 2) for _ in range(4)] for _ in surfaces.texels])
    points, expected = [], []
    for _ in range(count):
        pixel = [rng.randrange(n) for n in MASK_SIZE]
        at = [as_float(rng.uniform(-0.5, n + 0.5)) for n in SMALL_SIZE]
        *normal, metres = [as_float(v) for v in surface(at[0], 15)]
        points += [*pixel, *at, *normal, metres]
        blurred = [*mask_blur(mask, pixel, (1, 0)), *mask_blur(mask, pixel, (0, 1))]
        light = upsampled(ambient, surfaces, at, normal, metres)
        windings = [mask_winding(True, metres, 20), mask_winding(False, metres, 20)]
        expected += [*blurred, *light, 0, *windings, *[0] * 6]
    for name, picture in (("mask", mask), ("ambient", ambient), ("surface", surfaces)):
        picture.write(os.path.join(folder, name))
    write_floats(os.path.join(folder, "points"), points)
    write_floats(os.path.join(folder, "expected"), expected)
    write_floats(os.path.join(folder, "numbers"), [PIXELS_PER_METRE, SOFT_M])
    textures = [
        {"file": "mask", "size": MASK_SIZE, "format": "rg32float"},
        {"file": "ambient", "size": SMALL_SIZE, "format": "rgba32float"},
        {"file": "surface", "size": SMALL_SIZE, "format": "rgba32float"},
    ]
    with open(os.path.join(folder, "case.json"), "w", encoding="utf-8") as file:
        json.dump({"textures": textures, "atlas": False, "repeat": False}, file)
