"""Where plants and rocks go."""
import math

from island import CRATER, SOUTH_M, TOWER, WEST_M, distance_m, path_distance_m
from map_builder import MapError, yaw
import plants
from portable_math import between, cos_sin, smoothstep, stream

TREE_GAP_M, PLANT_GAP_M = 2.6, 1.0
ROCK_COUNT = 150


class Spacing:
    """Keeps things apart: a grid of cells that remembers who stands where."""

    def __init__(self, gap_m):
        self.gap_m, self.cells = gap_m, {}

    def take(self, x, y):
        i, j = math.floor(x / self.gap_m), math.floor(y / self.gap_m)
        near = (p for di in (-1, 0, 1) for dj in (-1, 0, 1) for p in self.cells.get((i + di, j + dj), ()))
        if any(distance_m(x, y, p) < self.gap_m for p in near):
            return False
        self.cells.setdefault((i, j), []).append((x, y))
        return True


def near_building(island, x, y, margin_m):
    """Within margin_m of a hut's or the tower's outer wall, taking a hut as a circle of 4.3 m."""
    near_hut = any(distance_m(x, y, (site.x, site.y)) < 4.3 + margin_m for site in island.sites)
    return near_hut or distance_m(x, y, TOWER) < 3.6 + margin_m


def choose_plant(island, rng, x, y):
    """The name of a plant that may grow here, or None."""
    height_m = island.ground_m(x, y)
    if height_m < 0.9 or near_building(island, x, y, 0.5):
        return None
    path_m, rock, jungle = path_distance_m(x, y), island.bare_rock(x, y), island.jungle(x, y)
    if path_m < 2.2 or rock > 0.7 or distance_m(x, y, CRATER) < 24:
        return None
    shore = 1 - smoothstep(2.5, 9, height_m)
    inland = smoothstep(2, 5, height_m)
    trees = 0 if near_building(island, x, y, 3.0) or path_m < 3 else 1 - rock
    chances = (
        ("palm_tall", trees * (0.16 * shore + 0.04 * jungle)),
        ("palm_short", trees * (0.16 * shore + 0.03 * jungle)),
        ("tree_open", trees * inland * (0.2 * jungle + 0.004)),
        ("tree_open_young", trees * inland * (0.12 * jungle + 0.006)),
        ("tree_dense", trees * inland * (0.2 * jungle + 0.002)),
        ("tree_dense_young", trees * inland * 0.12 * jungle),
        ("bush_leafy", 0.03 + 0.06 * jungle + 0.05 * shore),
        ("bush_dense", 0.03 + 0.05 * jungle),
        ("fern_large", inland * (0.015 + 0.12 * jungle)),
        ("fern_small", 0.02 + 0.07 * jungle * inland),
    )
    draw = rng.random()
    for name, chance in chances:
        if draw < chance:
            return name
        draw -= chance
    return None


def add_plants(builder, seed, count):
    island, rng = builder.island, stream(seed, "plants")
    trees, all_plants, planted = Spacing(TREE_GAP_M), Spacing(PLANT_GAP_M), 0
    for _ in range(60000 + 80 * count):
        if planted == count:
            return
        x, y = between(rng, WEST_M, island.east_m), between(rng, SOUTH_M, island.north_m)
        name = choose_plant(island, rng, x, y)
        if (
            not name
            or not all_plants.take(x, y)
            or (name.startswith(("palm", "tree")) and not trees.take(x, y))
        ):
            continue
        cosine, sine = cos_sin(rng.random())
        mesh = builder.mesh(name, lambda: plants.build_plant(seed, name))
        builder.writer.node(
            builder.vegetation_of_tile(x, y),
            name,
            mesh,
            (x, island.ground_m(x, y), -y),
            yaw(sine, cosine),
            (between(rng, 0.78, 1.22),) * 3,
        )
        planted += 1
    raise MapError(f"--plants {count}: the island has room for only {planted}")


def add_rocks(builder, seed):
    island, rng, spacing, placed = builder.island, stream(seed, "rocks"), Spacing(3.0), 0
    while placed < ROCK_COUNT:
        x, y = between(rng, WEST_M, island.east_m), between(rng, SOUTH_M, island.north_m)
        height_m = island.ground_m(x, y)
        likely = max(0.9 * island.bare_rock(x, y), 0.5 if -1.2 < height_m < 0.7 else 0.05)
        if (
            height_m < -1.2
            or path_distance_m(x, y) < 5
            or near_building(island, x, y, 4)
            or rng.random() > likely
        ):
            continue
        if not spacing.take(x, y):
            continue
        names = list(plants.ROCKS)
        name = names[int(rng.random() * len(names))]
        radius_m = 0.3 + 1.7 * rng.random() * rng.random()  # 0.5 to 4 m across, small ones more often
        rotation = [between(rng, -1, 1) for _ in range(4)]
        length = math.sqrt(
            rotation[0] * rotation[0]
            + rotation[1] * rotation[1]
            + rotation[2] * rotation[2]
            + rotation[3] * rotation[3]
        )
        mesh = builder.mesh(name, lambda: plants.build_rock(seed, name))
        builder.writer.node(
            builder.tile(x, y),
            name,
            mesh,
            (x, height_m - 0.25 * radius_m, -y),
            [value / length for value in rotation],
            (radius_m,) * 3,
        )
        placed += 1
