#!/usr/bin/env python3
"""Makes drtv's demo map: a volcanic island with jungle, rocks, two villages, a lookout tower and a pier, as glTF 2.0.

Writes island.gltf, island.bin and leaf.png. The same arguments give the same bytes on every machine. The ground is
Maunga Whau (maunga_whau.csv, see SOURCE.md); everything on it is made here. glTF frame: x east, y up, z south, metres.
Everything stands under one node for each 128 m tile, tile_<i>_<j>, with (i, j) = floor(world / 128).
"""
import argparse
from pathlib import Path
import sys

import buildings
from gltf_writer import GltfWriter
from island import PATHS, SOUTH_M, SPACING_M, TILE_M, TOWER, VILLAGES, WEST_M, Island
from map_builder import MapBuilder, MapError, print_stats, yaw
from plants import leaf_png
from portable_math import cos_sin
from scatter import add_plants, add_rocks
from shapes import Part

COPYRIGHT = "Ground: Maunga Whau, digitised by Ross Ihaka (R datasets). Models: drtv, CC0."
MOST_PLANTS = 20000

# Bright beside the day of day.json, whose noon is a tenth of a real one: one exposure holds from noon to night.
LANTERN_CD, HUT_LAMP_CD, FLAME_NITS = 26000, 700, 20000
POSTS_A_VILLAGE, POST_RING_M = 6, 13.0


def opaque(r, g, b):
    return {"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": 0}}


def leaf(r, g, b):
    return {
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1],
            "metallicFactor": 0,
            "baseColorTexture": {"index": 0},
        },
        "alphaMode": "MASK",
        "doubleSided": True,
    }


MATERIALS = {
    "ground": opaque(1, 1, 1),
    "sea": opaque(0.02, 0.05, 0.06),
    "bark": opaque(0.12, 0.08, 0.05),
    "basalt": opaque(0.09, 0.085, 0.08),
    "stone": opaque(0.2, 0.19, 0.17),
    "timber": opaque(0.25, 0.16, 0.08),
    "timber_grey": opaque(0.23, 0.2, 0.17),
    "thatch": opaque(0.3, 0.22, 0.1),
    "limewash": opaque(0.62, 0.58, 0.5),
    "clay": opaque(0.36, 0.13, 0.07),
    "ochre": opaque(0.45, 0.27, 0.08),
    "foliage": opaque(0.05, 0.095, 0.022),
    "flame": {
        **opaque(0.8, 0.5, 0.2),
        "emissiveFactor": [1, 0.6, 0.25],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": FLAME_NITS}},
    },
    "leaf_palm": leaf(0.95, 0.95, 0.9),
    "leaf_light": leaf(0.85, 0.9, 0.8),
    "leaf_dark": leaf(0.7, 0.75, 0.7),
    "leaf_fern": leaf(0.8, 1.0, 0.7),
}


def add_ground_and_sea(builder):
    per_tile = TILE_M // SPACING_M
    for first_row in range(0, builder.island.rows - 1, per_tile):
        for first_column in range(0, builder.island.columns - 1, per_tile):
            add_tile(
                builder,
                first_column,
                first_row,
                min(first_column + per_tile, builder.island.columns - 1),
                min(first_row + per_tile, builder.island.rows - 1),
            )


def add_tile(builder, first_column, first_row, last_column, last_row):
    island, ground = builder.island, Part("ground")
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            x, y = WEST_M + column * SPACING_M, SOUTH_M + row * SPACING_M
            ground.positions.append((x, island.heights_m[row][column], -y))
            ground.colours.append(island.colour(x, y))
    width = last_column - first_column + 1
    for south_west in range(len(ground.positions) - width):
        if south_west % width < width - 1:  # split from south-west to north-east, as Island.ground_m does
            south_east, north_west, north_east = south_west + 1, south_west + width, south_west + width + 1
            ground.triangles += [(north_west, south_west, north_east), (north_east, south_west, south_east)]
    west_m, south_m = WEST_M + first_column * SPACING_M, SOUTH_M + first_row * SPACING_M
    tile = builder.tile(west_m, south_m)
    builder.writer.node(tile, "ground", builder.mesh(f"ground_{first_column}_{first_row}", lambda: [ground]))
    if min(position[1] for position in ground.positions) < 0:
        share = (
            (last_column - first_column) * SPACING_M / TILE_M,
            1,
            (last_row - first_row) * SPACING_M / TILE_M,
        )
        builder.writer.node(
            tile,
            "sea",
            builder.mesh("sea", sea_square),
            (west_m, 0, -south_m),
            scale=None if share == (1, 1, 1) else share,
        )


def sea_square():
    return [
        Part(
            "sea", [(0, 0, 0), (TILE_M, 0, 0), (TILE_M, 0, -TILE_M), (0, 0, -TILE_M)], [(0, 1, 2), (0, 2, 3)]
        )
    ]


def add_huts(builder):
    """Every hut a static node; in each village the first two are marked as interiors, with a lamp and a probe of their own."""
    lamp = builder.writer.light("lamp", (1.0, 0.72, 0.42), HUT_LAMP_CD)
    inland_kinds, shore_kinds = ("hut_thatch", "hut_stone", "hut_lime"), ("hut_stilts", "hut_painted")
    for number, site in enumerate(builder.island.sites):
        kinds = shore_kinds if site.village == "shore" else inland_kinds
        kind_name = kinds[number % len(kinds)]
        kind = buildings.HUT_KINDS[kind_name]
        east, north = site.facing
        hut = builder.writer.node(
            builder.tile(site.x, site.y),
            f"hut_{site.name}",
            builder.mesh(kind_name, lambda: buildings.hut(kind)),
            (site.x, builder.island.ground_m(site.x, site.y), -site.y),
            yaw(east, -north),
        )
        if site.name.endswith(("_0", "_1")):
            low, high = kind.room()
            probe = f"probe_{site.name}"
            builder.writer.node(
                hut,
                f"room_{site.name}",
                builder.mesh(f"room_{kind_name}", lambda: buildings.volume(low, high)),
                bake_role="interior",
                bake_probe=probe,
            )
            builder.writer.node(hut, probe, translation=(0, kind.floor_m + 1.25, 0), bake_role="probe")
            under_ceiling = (0, kind.floor_m + buildings.ROOM_HEIGHT_M - 0.3, 0)
            builder.writer.node(
                hut, f"lamp_{site.name}", translation=under_ceiling, light=lamp, light_group="huts"
            )


def add_tower(builder):
    x, y = TOWER
    tower = builder.writer.node(
        builder.tile(x, y),
        "tower",
        builder.mesh("tower", buildings.tower),
        (x, builder.island.ground_m(x, y), -y),
        yaw(1.0, 0.0),
    )
    air = builder.mesh("tower_air", lambda: buildings.volume(*buildings.tower_air()))
    builder.writer.node(tower, "tower_air", air, bake_role="no_probes")


def add_lanterns(builder):
    """Posts around each village's green, their flames towards it; all lanterns of the island are one light group."""
    lantern = builder.writer.light("lantern", (1.0, 0.72, 0.42), LANTERN_CD)
    x_m, flame_m, _ = buildings.flame_of_post()
    for village, (x, y) in VILLAGES.items():
        for number in range(POSTS_A_VILLAGE):
            cosine, sine = cos_sin((number + 0.5) / POSTS_A_VILLAGE)
            at_x, at_y = x + POST_RING_M * cosine, y + POST_RING_M * sine
            post = builder.writer.node(
                builder.tile(at_x, at_y),
                f"post_{village}_{number}",
                builder.mesh("post", buildings.lantern_post),
                (at_x, builder.island.ground_m(at_x, at_y), -at_y),
                yaw(-sine, -cosine),
                light_group="lanterns",
            )
            below = (x_m, flame_m - buildings.LAMP_UNDER_FLAME_M, 0)
            builder.writer.node(
                post, f"lantern_{village}_{number}", translation=below, light=lantern, light_group="lanterns"
            )
    add_pier(builder, lantern)


def add_pier(builder, lantern):
    """It begins where its path meets the beach; at its end stand a lantern and a crate, which the game moves about."""
    x, y = PATHS[3][1]
    while builder.island.ground_m(x, y) > 0.7:
        x += 0.5
    pier = builder.writer.node(builder.tile(x, y), "pier", builder.mesh("pier", buildings.pier), (x, 0, -y))
    end = (buildings.PIER_LENGTH_M - 1, buildings.PIER_DECK_M, 0.6)
    crate = builder.mesh("crate", lambda: [crate_part()])
    builder.writer.node(pier, "crate", crate, end, bake_role="ignore")
    above_deck = (end[0], 3.2, -1.0)
    builder.writer.node(pier, "lantern", translation=above_deck, light=lantern, light_group="lanterns")


def crate_part():
    part = Part("timber")
    buildings.box(part, (-0.45, 0, -0.45), (0.45, 0.9, 0.45))
    return part


class Arguments(argparse.ArgumentParser):
    def error(self, message):
        raise MapError(message)


def parse_arguments():
    parser = Arguments(description="Make drtv's demo map.", allow_abbrev=False)
    parser.add_argument(
        "--out", required=True, type=Path, help="folder for island.gltf, island.bin and leaf.png"
    )
    parser.add_argument("--seed", type=int, default=1, help="another island of the same shape (default 1)")
    parser.add_argument("--plants", type=int, default=6000, help=f"0 to {MOST_PLANTS} (default 6000)")
    parser.add_argument("--stats", action="store_true", help="tell counts and extents on stderr")
    arguments = parser.parse_args()
    if not 0 <= arguments.plants <= MOST_PLANTS:
        raise MapError(f"--plants {arguments.plants} is not within 0 to {MOST_PLANTS}")
    return arguments


def main():
    try:
        arguments = parse_arguments()
        arguments.out.mkdir(parents=True, exist_ok=True)
        island = Island(Path(__file__).with_name("maunga_whau.csv"), arguments.seed)
        builder = MapBuilder(island, GltfWriter(MATERIALS, "leaf.png", COPYRIGHT))
        add_ground_and_sea(builder)
        add_huts(builder)
        add_tower(builder)
        add_lanterns(builder)
        add_rocks(builder, arguments.seed)
        add_plants(builder, arguments.seed, arguments.plants)
        if arguments.plants > 0:
            (arguments.out / "leaf.png").write_bytes(leaf_png())
        builder.writer.write(arguments.out, "island")
        if arguments.stats:
            print_stats(builder)
    except (MapError, OSError) as problem:
        print(f"make_demo_map: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
