"""Procedural plants and rocks, all the project's own, and the leaf texture."""
import math
import struct
import zlib

from portable_math import add, between, cos_sin, cross, dot, random_direction, scaled, stream, unit
from shapes import Part, append, blob, card, frond, tube, unit_icosphere

LEAF_PIXELS = 64
LEAF_SRGB = (84, 113, 52)  # linear 0.09, 0.165, 0.034; the materials' factors darken it
LEAFLET_PAIRS = 8


def palm(rng, height_m):
    trunk, leaves = Part("bark"), Part("leaf_palm")
    lean_m = between(rng, 0.8, 1.8)
    spine = [
        (lean_m * (k * k) / 36, height_m * k / 6 - 0.4, 0.0) for k in range(7)
    ]  # its foot stands in the ground
    tube(trunk, spine, [0.22 - 0.018 * k for k in range(7)], 6)
    for k in range(10):
        frond(
            leaves,
            spine[-1],
            k / 10 + between(rng, -0.02, 0.02),
            between(rng, 2.6, 3.3),
            between(rng, 0.4, 0.5),
            between(rng, 0.35, 0.9),
            between(rng, 0.9, 1.3),
            5,
        )
    return [trunk, leaves]


def trunk_and_branches(rng, height_m, radius_m, branch_count, reach_m):
    """The wood, and the tips that carry leaves."""
    wood = Part("bark")
    bend = random_direction(rng)
    spine = [
        (0.05 * height_m * t * bend[0], height_m * t - 0.4, 0.05 * height_m * t * bend[2])
        for t in (0.0, 0.3, 0.65, 1.0)
    ]
    tube(wood, spine, [radius_m * share for share in (1.25, 0.85, 0.65, 0.3)], 6)
    tips = [spine[3]]
    for k in range(branch_count):
        cosine, sine = cos_sin(k / branch_count + between(rng, -0.05, 0.05))
        start = add(scaled(spine[2], 0.8), scaled(spine[3], 0.2))
        out_m = reach_m * between(rng, 0.75, 1.1)
        tip = add(start, (out_m * cosine, between(rng, 0.1, 0.3) * height_m, out_m * sine))
        tube(
            wood,
            [start, add(scaled(start, 0.5), add(scaled(tip, 0.5), (0, -0.15, 0))), tip],
            [0.45 * radius_m, 0.3 * radius_m, 0.1 * radius_m],
            4,
        )
        tips.append(tip)
    return wood, tips


def leaf_cards(part, rng, centre, radii_m, count, size_m):
    """Sprigs on the shell of an ellipsoid; they point outward and hang a little."""
    for _ in range(count):
        out = random_direction(rng)
        base = add(centre, tuple(o * r * between(rng, 0.45, 0.9) for o, r in zip(out, radii_m)))
        along = unit(add(add(out, scaled(random_direction(rng), 0.5)), (0, -0.25, 0)))
        across = unit(cross(along, random_direction(rng)))
        length_m = size_m * between(rng, 0.8, 1.2)
        card(part, base, scaled(along, length_m), scaled(across, 0.7 * length_m))


def open_tree(rng, height_m):
    """Broadleaf of cards alone: light falls through its crown."""
    wood, tips = trunk_and_branches(rng, 0.72 * height_m, 0.025 * height_m, 5, 0.24 * height_m)
    leaves = Part("leaf_light")
    for tip in tips:
        leaf_cards(leaves, rng, tip, (0.19 * height_m, 0.14 * height_m, 0.19 * height_m), 24, 0.15 * height_m)
    return [wood, leaves]


def dense_tree(rng, height_m):
    """Broadleaf with an opaque heart of foliage in each clump and cards around it."""
    wood, tips = trunk_and_branches(rng, 0.7 * height_m, 0.03 * height_m, 4, 0.2 * height_m)
    hearts, leaves = Part("foliage"), Part("leaf_dark")
    for tip in tips:
        radius_m = between(rng, 0.13, 0.17) * height_m
        blob(hearts, rng, tip, (radius_m, 0.75 * radius_m, radius_m))
        leaf_cards(leaves, rng, tip, (1.3 * radius_m, radius_m, 1.3 * radius_m), 14, 0.13 * height_m)
    return [wood, hearts, leaves]


def leafy_bush(rng, size_m):
    leaves = Part("leaf_light")
    leaf_cards(
        leaves, rng, (0, 0.35 * size_m, 0), (0.6 * size_m, 0.5 * size_m, 0.6 * size_m), 30, 0.45 * size_m
    )
    return [leaves]


def dense_bush(rng, size_m):
    heart, leaves = Part("foliage"), Part("leaf_dark")
    blob(heart, rng, (0, 0.25 * size_m, 0), (0.55 * size_m, 0.4 * size_m, 0.5 * size_m))
    leaf_cards(
        leaves, rng, (0, 0.3 * size_m, 0), (0.6 * size_m, 0.5 * size_m, 0.6 * size_m), 16, 0.4 * size_m
    )
    return [heart, leaves]


def fern(rng, length_m):
    leaves = Part("leaf_fern")
    for k in range(9):
        frond(
            leaves,
            (0, 0.02, 0),
            k / 9 + between(rng, -0.03, 0.03),
            length_m * between(rng, 0.8, 1.1),
            0.17 * length_m,
            between(rng, 0.8, 1.3),
            between(rng, 0.7, 1.0),
            4,
        )
    return [leaves]


def rock(rng, level, cuts):
    """A ball of radius 1 m cut by planes: broken basalt."""
    positions, triangles = unit_icosphere(level)
    planes = [(random_direction(rng), between(rng, 0.55, 0.85)) for _ in range(cuts)]

    def radius_m(direction):
        # The nearest plane along the ray from the centre: the surface stays a function of direction.
        facing = [
            offset / dot(direction, normal) for normal, offset in planes if dot(direction, normal) > 0.2
        ]
        return min(facing + [1.0])

    part = Part("basalt")
    append(part, [scaled(p, radius_m(p)) for p in positions], triangles)
    return [part]


PLANTS = {  # name: (model, its size in metres)
    "palm_tall": (palm, 8.6),
    "palm_short": (palm, 6.2),
    "tree_open": (open_tree, 11.0),
    "tree_open_young": (open_tree, 8.0),
    "tree_dense": (dense_tree, 11.5),
    "tree_dense_young": (dense_tree, 8.5),
    "bush_leafy": (leafy_bush, 1.6),
    "bush_dense": (dense_bush, 1.4),
    "fern_large": (fern, 1.3),
    "fern_small": (fern, 0.8),
}
ROCKS = {"rock_pebble": (1, 7), "rock_block": (2, 9), "rock_slab": (2, 14)}  # name: (icosphere level, cuts)


def build_plant(seed, name):
    model, size_m = PLANTS[name]
    return model(stream(seed, name), size_m)


def build_rock(seed, name):
    return rock(stream(seed, name), *ROCKS[name])


def inside_sprig(across, t):
    """A stem with pairs of leaflets that point forward; across -1..1, t 0 at the base and 1 at the tip."""
    distance = abs(across)
    if distance < 0.05:
        return t < 0.97
    root = t - 0.28 * distance  # where this leaflet leaves the stem
    if not 0.03 < root < 0.97:
        return False
    reach = 1.9 * math.sqrt(root * (1 - root)) * 0.98
    in_pair = abs(root * LEAFLET_PAIRS % 1 - 0.5)  # 0 on the leaflet's own rib
    return distance < reach and in_pair < 0.46 * (1 - (distance / reach) * (distance / reach))


def leaf_pixel(column, row):
    """RGBA; the colour goes on under the transparent pixels so that filtering cannot bring a fringe in."""
    covered = 0
    for sample in range(16):
        across = (column + (sample % 4 + 0.5) / 4) / LEAF_PIXELS * 2 - 1
        t = 1 - (row + (sample // 4 + 0.5) / 4) / LEAF_PIXELS
        covered += inside_sprig(across, t)
    across = abs(2 * column + 1 - LEAF_PIXELS)
    percent = 88 if across < 4 else 94 + 12 * across // LEAF_PIXELS
    return [channel * percent // 100 for channel in LEAF_SRGB] + [covered * 255 // 16]


def leaf_png():
    rows = b"".join(
        bytes([0] + [value for column in range(LEAF_PIXELS) for value in leaf_pixel(column, row)])
        for row in range(LEAF_PIXELS)
    )
    # One stored deflate block, since compressors differ between zlib builds and the bytes may not.
    data = (
        b"\x78\x01\x01"
        + struct.pack("<HH", len(rows), len(rows) ^ 0xFFFF)
        + rows
        + struct.pack(">I", zlib.adler32(rows))
    )
    header = struct.pack(">IIBBBBB", LEAF_PIXELS, LEAF_PIXELS, 8, 6, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", data), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        for kind, body in chunks
    )
