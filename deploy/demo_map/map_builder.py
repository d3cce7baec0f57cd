"""The map under construction: tiles, shared meshes, and what it all comes to."""
import math
import sys

from island import SECTOR_M, SOUTH_M, TILE_M, WEST_M
from portable_math import add, cross, scaled


class MapError(Exception):
    """A mistake in the arguments, told in one sentence."""


def yaw(sine, cosine):
    """The turn about +y that takes +z to (sine, 0, cosine)."""
    half_sine = math.sqrt(max(0.0, (1 - cosine) / 2))
    return (0.0, half_sine if sine >= 0 else -half_sine, 0.0, math.sqrt(max(0.0, (1 + cosine) / 2)))


def turned(rotation, v):
    axis, w = rotation[:3], rotation[3]
    t = scaled(cross(axis, v), 2)
    return add(v, add(scaled(t, w), cross(axis, t)))


class MapBuilder:
    """The glTF under construction and its tiles; meshes are made when first used and shared from then on."""

    def __init__(self, island, writer):
        self.island, self.writer = island, writer
        self.mesh_index, self.mesh_parts, self.tiles, self.vegetation = {}, [], {}, {}

    def mesh(self, name, make_parts):
        if name not in self.mesh_index:
            parts = make_parts()
            self.mesh_index[name] = self.writer.mesh(name, parts)
            self.mesh_parts.append(parts)
        return self.mesh_index[name]

    def tile(self, x, y):
        key = (math.floor(x / TILE_M), math.floor(y / TILE_M))
        if key not in self.tiles:
            self.tiles[key] = self.writer.node(None, f"tile_{key[0]}_{key[1]}")
        return self.tiles[key]

    def vegetation_of_tile(self, x, y):
        tile = self.tile(x, y)
        if tile not in self.vegetation:
            self.vegetation[tile] = self.writer.node(
                tile, f"plants_{len(self.vegetation)}", bake_role="vegetation"
            )
        return self.vegetation[tile]


def instances(builder):
    """(mesh, world corners of its bounds) of every mesh node."""
    nodes, accessors = builder.writer.root["nodes"], builder.writer.root["accessors"]

    def visit(index, place):
        node = nodes[index]
        shift, rotation, scale = (
            node.get("translation", (0, 0, 0)),
            node.get("rotation", (0, 0, 0, 1)),
            node.get("scale", (1, 1, 1)),
        )
        here = lambda p: place(add(turned(rotation, tuple(a * s for a, s in zip(p, scale))), shift))
        if "mesh" in node:
            corners = []
            for primitive in builder.writer.root["meshes"][node["mesh"]]["primitives"]:
                bounds = accessors[primitive["attributes"]["POSITION"]]
                low, high = bounds["min"], bounds["max"]
                corners += [
                    here((x, y, z))
                    for x in (low[0], high[0])
                    for y in (low[1], high[1])
                    for z in (low[2], high[2])
                ]
            yield node["mesh"], corners
        for child in node.get("children", ()):
            yield from visit(child, here)

    for root in builder.writer.root["scenes"][0]["nodes"]:
        yield from visit(root, lambda p: p)


def print_stats(builder):
    triangles = [sum(len(part.triangles) for part in parts) for parts in builder.mesh_parts]
    drawn, corners = 0, []
    objects = list(instances(builder))
    for mesh, mesh_corners in objects:
        drawn += triangles[mesh]
        corners += mesh_corners
    low, high = ([pick(corner[axis] for corner in corners) for axis in range(3)] for pick in (min, max))
    plant_count = sum(
        len(builder.writer.root["nodes"][node]["children"]) for node in builder.vegetation.values()
    )
    sectors = ((builder.island.east_m - 1) // SECTOR_M - WEST_M // SECTOR_M + 1) * (
        (builder.island.north_m - 1) // SECTOR_M - SOUTH_M // SECTOR_M + 1
    )
    print(
        f"objects {len(objects)} (plants {plant_count}), meshes {len(triangles)}\n"
        f"triangles {sum(triangles)} unique, {drawn} instanced\n"
        f"extent glTF x {low[0]:.1f}..{high[0]:.1f} y {low[1]:.1f}..{high[1]:.1f} z {low[2]:.1f}..{high[2]:.1f}\n"
        f"extent world x {low[0]:.1f}..{high[0]:.1f} y {-high[2]:.1f}..{-low[2]:.1f} z {low[1]:.1f}..{high[1]:.1f}\n"
        f"sectors {sectors}",
        file=sys.stderr,
    )
