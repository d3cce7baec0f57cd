"""Closed solids and leaf cards, in metres, glTF frame (+y up). Front faces are counter-clockwise seen from outside."""
from dataclasses import dataclass, field
import math

from portable_math import add, between, cos_sin, cross, dot, scaled, unit


@dataclass
class Part:
    """The triangles of a mesh that share a material."""

    material: str
    positions: list = field(default_factory=list)
    triangles: list = field(default_factory=list)
    uvs: list = field(default_factory=list)  # empty, or one a position
    colours: list = field(default_factory=list)  # empty, or one linear RGB a position


def append(part, positions, triangles, uvs=()):
    first = len(part.positions)
    part.positions.extend(positions)
    part.uvs.extend(uvs)
    part.triangles.extend(tuple(first + i for i in triangle) for triangle in triangles)


def box(part, low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    prism(part, x0, x1, [(y0, z0), (y1, z0), (y1, z1), (y0, z1)])


def prism(part, x0, x1, outline):
    """A convex outline of (y, z), counter-clockwise seen from +x, swept from x0 to x1."""
    n = len(outline)
    sides = [(k, (k + 1) % n) for k in range(n)]
    append(
        part,
        [(x, y, z) for x in (x0, x1) for y, z in outline],
        [(a, b, n + b) for a, b in sides]
        + [(a, n + b, n + a) for a, b in sides]
        + [(0, k + 1, k) for k in range(1, n - 1)]
        + [(n, n + k, n + k + 1) for k in range(1, n - 1)],
    )


def tube(part, spine, radii_m, sides):
    """A capped tube through the spine's points, as a trunk or a branch."""
    first = unit(add(spine[1], scaled(spine[0], -1)))
    reference = (1.0, 0.0, 0.0) if abs(first[1]) > 0.7 else (0.0, 1.0, 0.0)
    positions, last = [], len(spine) - 1
    for k, (centre, radius_m) in enumerate(zip(spine, radii_m)):
        axis = unit(add(spine[min(k + 1, last)], scaled(spine[max(k - 1, 0)], -1)))
        u = unit(cross(reference, axis))
        v = cross(axis, u)
        for side in range(sides):
            cosine, sine = cos_sin(side / sides)
            positions.append(add(centre, add(scaled(u, radius_m * cosine), scaled(v, radius_m * sine))))
    positions += [spine[0], spine[-1]]
    triangles, top = [], last * sides
    for a, b in ((side, (side + 1) % sides) for side in range(sides)):
        for ring in range(0, top, sides):
            triangles += [
                (ring + a, ring + b, ring + sides + b),
                (ring + a, ring + sides + b, ring + sides + a),
            ]
        triangles += [(top + sides, b, a), (top + sides + 1, top + a, top + b)]
    append(part, positions, triangles)


def unit_icosphere(level):
    golden = (1 + math.sqrt(5)) / 2
    corners = [p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    near = lambda p, q: dot(add(p, scaled(q, -1)), add(p, scaled(q, -1))) < 4.1  # an edge is 2 long
    triangles = []
    for i, p in enumerate(corners):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                q, r = corners[j], corners[k]
                if near(p, q) and near(q, r) and near(r, p):
                    triangles.append((i, j, k) if dot(cross(p, q), r) > 0 else (i, k, j))
    positions = [unit(p) for p in corners]
    for _ in range(level):
        positions, triangles = subdivided(positions, triangles)
    return positions, triangles


def subdivided(positions, triangles):
    positions, finer, middles = list(positions), [], {}

    def middle(i, j):
        key = (min(i, j), max(i, j))
        if key not in middles:
            middles[key] = len(positions)
            positions.append(unit(add(positions[i], positions[j])))
        return middles[key]

    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return positions, finer


def blob(part, rng, centre, radii_m):
    """A clump of foliage: a ball whose surface is uneven along its radii, so it cannot fold over itself."""
    positions, triangles = unit_icosphere(1)
    uneven = [scaled(p, between(rng, 0.8, 1.1)) for p in positions]
    append(
        part,
        [add(centre, (p[0] * radii_m[0], p[1] * radii_m[1], p[2] * radii_m[2])) for p in uneven],
        triangles,
    )


def card(part, base, along, side):
    """One leaf card from its base to its tip; `side` is its whole width."""
    left, right = add(base, scaled(side, -0.5)), add(base, scaled(side, 0.5))
    append(
        part,
        [left, right, add(right, along), add(left, along)],
        [(0, 1, 2), (0, 2, 3)],
        [(0, 1), (1, 1), (1, 0), (0, 0)],
    )


def frond(part, base, turns, length_m, half_width_m, rise, fall, steps):
    """A bent strip two cards wide. It leaves `base` with slope `rise` and bends down by `fall` at the tip."""
    cosine, sine = cos_sin(turns)
    positions, uvs, triangles = [], [], []
    for k in range(steps + 1):
        t = k / steps
        x, y = length_m * t, length_m * (rise * t - fall * t * t)
        for side in (-1, 0, 1):
            across = side * half_width_m
            droop = 0.35 * half_width_m * abs(side)
            positions.append(add(base, (x * cosine - across * sine, y - droop, x * sine + across * cosine)))
            uvs.append((0.5 + 0.5 * side, 1 - t))
    for k in range(0, 3 * steps, 3):
        for a in (k, k + 1):
            triangles += [(a, a + 1, a + 4), (a, a + 4, a + 3)]
    append(part, positions, triangles, uvs)
