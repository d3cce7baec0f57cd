"""The island's ground and its plan: where villages, paths and crater are. World frame: x east, y north, z up, metres.

The published heights stand 10 m apart; the ground between them is Catmull-Rom, lightly roughened, on a 4 m grid whose
lines fall on the tiles' borders. Toward the map's edge it sinks below the sea at z = 0.
"""
import csv
from dataclasses import dataclass
import math

from portable_math import cos_sin, layered_noise, mix, smoothstep

WEST_M, SOUTH_M = -384, -256  # a sector corner; the map straddles the origin
SAMPLE_M, SPACING_M, TILE_M, SECTOR_M = 10, 4, 128, 64
SEA_LEVEL_M, SEABED_M = 98.0, -11.0  # in the published heights; in ours
SHELF = 0.3  # how far in the ground has risen from the seabed; 1 is from edge to middle

CRATER = (-94.0, 76.0)
TOWER = (-4.0, 12.0)
VILLAGES = {"shore": (246.0, 230.0), "inland": (222.0, -78.0)}
PATHS = [
    [(246, 230), (254, 150), (222, 66), (232, -20), (222, -78)],  # village to village
    [(222, -78), (150, -62), (92, -22), (34, 2), (2, 12)],  # up to the tower
    [(2, 12), (-6, 20), (-52, 40), (-94, 76)],  # down into the crater
    [(246, 230), (284, 226), (340, 226)],
]  # to the pier

SAND, WET_SAND, DIRT = (0.5, 0.43, 0.3), (0.3, 0.25, 0.17), (0.22, 0.15, 0.09)
GRASS, FOREST_FLOOR, BASALT = (0.11, 0.17, 0.05), (0.075, 0.075, 0.035), (0.09, 0.085, 0.08)


@dataclass(frozen=True)
class HutSite:
    name: str
    village: str
    x: float
    y: float
    facing: tuple  # the way its door looks, (east, north), a unit vector


def village_sites():
    """Ten huts a village in two rings about its green; doors look at the green."""
    sites = []
    for village, (x, y) in VILLAGES.items():
        for k in range(10):
            cosine, sine = cos_sin(k / 10 + 0.05 + 0.012 * ((k * 7) % 5 - 2))
            ring_m = (20.0, 33.0)[k % 2]
            sites.append(
                HutSite(f"{village}_{k}", village, x + ring_m * cosine, y + ring_m * sine, (-cosine, -sine))
            )
    return sites


def distance_m(x, y, point):
    dx, dy = x - point[0], y - point[1]
    return math.sqrt(dx * dx + dy * dy)


def path_distance_m(x, y):
    nearest = 1e30
    for path in PATHS:
        for (ax, ay), (bx, by) in zip(path, path[1:]):
            dx, dy = bx - ax, by - ay
            t = min(1.0, max(0.0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)))
            ex, ey = x - ax - t * dx, y - ay - t * dy
            nearest = min(nearest, ex * ex + ey * ey)
    return math.sqrt(nearest)


def catmull_rom(before, a, b, after, t):
    return a + 0.5 * t * (
        b - before + t * (2 * before - 5 * a + 4 * b - after + t * (3 * (a - b) + after - before))
    )


class Island:
    """Heights and colours at the grid's vertices; constant after construction."""

    def __init__(self, csv_path, seed):
        with open(csv_path, newline="") as file:
            self.published_m = [
                [float(cell) for cell in row] for row in csv.reader(file)
            ]  # rows from north to south
        self.seed = seed
        self.columns = (len(self.published_m[0]) - 1) * SAMPLE_M // SPACING_M + 1
        self.rows = (len(self.published_m) - 1) * SAMPLE_M // SPACING_M + 1
        self.east_m = WEST_M + (self.columns - 1) * SPACING_M
        self.north_m = SOUTH_M + (self.rows - 1) * SPACING_M
        self.sites = village_sites()
        pads = [(s.x, s.y, 4.5, max(0.9, self.natural_height_m(s.x, s.y))) for s in self.sites]
        pads.append((*TOWER, 4.0, self.natural_height_m(*TOWER)))
        self.heights_m = [
            [
                self.padded_height_m(WEST_M + i * SPACING_M, SOUTH_M + j * SPACING_M, pads)
                for i in range(self.columns)
            ]
            for j in range(self.rows)
        ]

    def published_height_m(self, x, y):
        column, row = (x - WEST_M) / SAMPLE_M, (self.north_m - y) / SAMPLE_M
        i, j = math.floor(column), math.floor(row)
        last_i, last_j = len(self.published_m[0]) - 1, len(self.published_m) - 1
        columns = [min(max(i + k, 0), last_i) for k in (-1, 0, 1, 2)]
        lines = (self.published_m[min(max(j + k, 0), last_j)] for k in (-1, 0, 1, 2))
        return catmull_rom(*(catmull_rom(*(line[c] for c in columns), column - i) for line in lines), row - j)

    def natural_height_m(self, x, y):
        u = (2 * x - WEST_M - self.east_m) / (self.east_m - WEST_M)
        v = (2 * y - SOUTH_M - self.north_m) / (self.north_m - SOUTH_M)
        inward = max(
            0.0, 1 - math.sqrt(math.sqrt(u * u * u * u + v * v * v * v))
        )  # 0 on a rounded oblong in the map
        bays = 0.35 + 1.3 * layered_noise(x / 110, y / 110, self.seed * 16 + 1)
        above_m = (
            self.published_height_m(x, y)
            - SEA_LEVEL_M
            + 1.6 * (layered_noise(x / 17, y / 17, self.seed * 16 + 4) - 0.5)
        )
        height_m = mix(SEABED_M, above_m, smoothstep(0, SHELF, inward * bays))
        return height_m * mix(
            0.35, 1.0, smoothstep(0, 7, abs(height_m))
        )  # a flat beach on both sides of the waterline

    def padded_height_m(self, x, y, pads):
        """The ground is level under each building; where two pads overlap, the nearer one has the last word."""
        height_m = self.natural_height_m(x, y)
        near = [(distance_m(x, y, pad), pad) for pad in pads if abs(x - pad[0]) < 20 and abs(y - pad[1]) < 20]
        for from_pad_m, (_, _, radius_m, pad_m) in sorted(near, reverse=True):
            level = 1 - smoothstep(radius_m + 1.5 * SPACING_M, radius_m + 3.5 * SPACING_M, from_pad_m)
            height_m = mix(height_m, pad_m, level)
        return height_m

    def ground_m(self, x, y):
        """Height of the triangle below (x, y), so that things stand on the mesh and not on the ideal surface."""
        column, row = (x - WEST_M) / SPACING_M, (y - SOUTH_M) / SPACING_M
        i, j = min(int(column), self.columns - 2), min(int(row), self.rows - 2)
        u, v = column - i, row - j
        (south_west, south_east), (north_west, north_east) = (
            self.heights_m[j][i : i + 2],
            self.heights_m[j + 1][i : i + 2],
        )
        if v > u:
            return south_west + v * (north_west - south_west) + u * (north_east - north_west)
        return south_west + u * (south_east - south_west) + v * (north_east - south_east)

    def slope(self, x, y):
        """Rise over run, over one spacing to each side."""
        x = min(max(x, WEST_M + SPACING_M), self.east_m - SPACING_M)
        y = min(max(y, SOUTH_M + SPACING_M), self.north_m - SPACING_M)
        dx = self.ground_m(x + SPACING_M, y) - self.ground_m(x - SPACING_M, y)
        dy = self.ground_m(x, y + SPACING_M) - self.ground_m(x, y - SPACING_M)
        return math.sqrt(dx * dx + dy * dy) / (2 * SPACING_M)

    def jungle(self, x, y):
        """0 in the open, 1 in the thick of it: clumps, none in villages, in the crater or at the tower."""
        clumps = smoothstep(0.4, 0.56, layered_noise(x / 90, y / 90, self.seed * 16 + 7))
        for centre in VILLAGES.values():
            clumps *= smoothstep(35, 60, distance_m(x, y, centre))
        return (
            clumps * smoothstep(28, 60, distance_m(x, y, CRATER)) * smoothstep(8, 26, distance_m(x, y, TOWER))
        )

    def bare_rock(self, x, y):
        patches = smoothstep(0.42, 0.6, layered_noise(x / 24, y / 24, self.seed * 16 + 10))
        crater = (1 - smoothstep(50, 95, distance_m(x, y, CRATER))) * smoothstep(
            18, 34, distance_m(x, y, CRATER)
        )
        return max(smoothstep(0.55, 0.8, self.slope(x, y)), crater * patches)

    def colour(self, x, y):
        """Linear albedo of the ground."""
        height_m = self.ground_m(x, y)
        grain = layered_noise(x / 9, y / 9, self.seed * 16 + 13)
        layers = (
            (FOREST_FLOOR, self.jungle(x, y)),
            (BASALT, self.bare_rock(x, y)),
            (SAND, 1 - smoothstep(1.3, 2.6, height_m + grain)),
            (WET_SAND, 1 - smoothstep(0.05, 0.5, height_m)),
            (DIRT, 0.85 * (1 - smoothstep(1.0, 3.2, path_distance_m(x, y))) * smoothstep(0.3, 1.0, height_m)),
        )
        colour = GRASS
        for layer, share in layers:
            colour = tuple(mix(a, b, share) for a, b in zip(colour, layer))
        return tuple(channel * (0.85 + 0.3 * grain) for channel in colour)
