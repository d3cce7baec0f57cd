"""Huts, tower and pier: closed boxes and prisms that meet without gaps. A hut's door faces its own +z.

Each kind of building returns the parts of its mesh. The ground is y = 0 and the solids go below it.
"""
from dataclasses import dataclass

from shapes import Part, box, prism

WALL_M = 0.18
ROOM_HEIGHT_M = 2.4
# How far an interior reaches beyond the inner faces: half of what it fades over, so that it holds at the walls
# themselves (docs/runtime.md).
ROOM_MARGIN_M = 0.5
DOOR_M = (1.0, 2.0)  # width, height
ROOF_M = 0.22  # thickness, along y
EAVES_M = 0.55  # how far the roof stands out
ROOF_SLOPE = 0.8
PIER_LENGTH_M, PIER_WIDTH_M, PIER_DECK_M = 54.0, 2.4, 1.1


@dataclass(frozen=True)
class HutKind:
    length_m: float  # along x, outside; the ridge lies along it
    depth_m: float  # along z, outside
    floor_m: float  # the room's floor above the ground
    wall: str  # material
    roof: str

    def room(self):
        """Low and high corner of the room's interior."""
        x, z = self.length_m / 2 - WALL_M + ROOM_MARGIN_M, self.depth_m / 2 - WALL_M + ROOM_MARGIN_M
        return (-x, self.floor_m - ROOM_MARGIN_M, -z), (x, self.floor_m + ROOM_HEIGHT_M + ROOM_MARGIN_M, z)


HUT_KINDS = {
    "hut_thatch": HutKind(5.2, 4.2, 0.12, "timber", "thatch"),
    "hut_stone": HutKind(6.0, 4.4, 0.12, "basalt", "thatch"),
    "hut_lime": HutKind(7.2, 4.6, 0.15, "limewash", "clay"),
    "hut_stilts": HutKind(5.4, 4.2, 1.2, "timber", "thatch"),
    "hut_painted": HutKind(6.2, 4.2, 1.2, "ochre", "timber_grey"),
}


def wall(part, along_x, span, across, y0, height_m, openings):
    """A wall with rectangular holes (start, end, bottom, top), measured along the wall and from its foot."""

    def piece(start, end, bottom, top):
        low, high = (start, y0 + bottom, across[0]), (end, y0 + top, across[1])
        box(part, *((low, high) if along_x else (low[::-1], high[::-1])))

    at = span[0]
    for start, end, bottom, top in openings:
        piece(at, start, 0, height_m)
        if bottom > 0:
            piece(start, end, 0, bottom)
        piece(start, end, top, height_m)
        at = end
    piece(at, span[1], 0, height_m)


def gabled_roof(walls, roof, kind, top_m):
    """Two slabs that meet at the ridge, and the gables. Slabs and gables run into each other: no light leaks."""
    half_depth, half_length = kind.depth_m / 2, kind.length_m / 2
    under = lambda z: top_m + ROOF_SLOPE * (
        half_depth - WALL_M - z
    )  # the slab's lower face rests on the wall's inner edge
    eave, x = half_depth + EAVES_M, half_length + EAVES_M
    prism(
        roof,
        -x,
        x,
        [(under(0), 0), (under(eave), eave), (under(eave) + ROOF_M, eave), (under(0) + ROOF_M, 0)][::-1],
    )
    prism(
        roof,
        -x,
        x,
        [(under(0), 0), (under(eave), -eave), (under(eave) + ROOF_M, -eave), (under(0) + ROOF_M, 0)],
    )
    foot = half_depth - WALL_M + 0.06 / ROOF_SLOPE
    for x0, x1 in ((-half_length, WALL_M - half_length), (half_length - WALL_M, half_length)):
        prism(walls, x0, x1, [(top_m, -foot), (under(0) + 0.06, 0), (top_m, foot)])


def hut(kind):
    walls, roof, timber = Part(kind.wall), Part(kind.roof), Part("timber")
    x, z, floor = kind.length_m / 2, kind.depth_m / 2, kind.floor_m
    door = (-0.25 * kind.length_m, -0.25 * kind.length_m + DOOR_M[0], 0, DOOR_M[1])
    front_window = (0.12 * kind.length_m, 0.12 * kind.length_m + 0.9, 0.9, 1.8)
    side_window = (-0.4, 0.4, 0.9, 1.8)
    wall(walls, True, (-x, x), (z - WALL_M, z), floor, ROOM_HEIGHT_M, [door, front_window])
    wall(walls, True, (-x, x), (-z, WALL_M - z), floor, ROOM_HEIGHT_M, [(-0.5, 0.5, 0.9, 1.8)])
    wall(walls, False, (WALL_M - z, z - WALL_M), (x - WALL_M, x), floor, ROOM_HEIGHT_M, [side_window])
    wall(walls, False, (WALL_M - z, z - WALL_M), (-x, WALL_M - x), floor, ROOM_HEIGHT_M, [side_window])
    ceiling = floor + ROOM_HEIGHT_M
    box(timber, (-x, ceiling, -z), (x, ceiling + 0.08, z))
    gabled_roof(walls, roof, kind, ceiling + 0.08)
    door_x = (door[0] + door[1]) / 2
    if floor > 0.5:
        stilts_and_steps(timber, x, z, floor, door_x)
    else:
        box(timber, (-x, -0.6, -z), (x, floor, z))
    return [walls, roof, timber]


def stilts_and_steps(timber, x, z, floor, door_x):
    box(timber, (-x, floor - 0.15, -z), (x, floor, z))
    for px in (-x + 0.2, 0.0, x - 0.2):
        for pz in (-z + 0.2, z - 0.2):
            box(timber, (px - 0.11, -1.2, pz - 0.11), (px + 0.11, floor - 0.15, pz + 0.11))
    for step in range(4):
        box(
            timber,
            (door_x - 0.6, -0.3, z + 0.3 * step),
            (door_x + 0.6, floor * (4 - step) / 5, z + 0.3 * step + 0.3),
        )


TOWER_HALF_M, TOWER_WALL_M, TOWER_HEIGHT_M = 2.4, 0.5, 7.5


def tower():
    """A square lookout of stone with a door, two slits and a battlement."""
    stone, half, inner = Part("stone"), TOWER_HALF_M, TOWER_HALF_M - TOWER_WALL_M
    box(stone, (-half, -1.0, -half), (half, 0.1, half))
    wall(stone, True, (-half, half), (inner, half), 0.1, TOWER_HEIGHT_M, [(-0.5, 0.5, 0, 2.0)])
    wall(stone, True, (-half, half), (-half, -inner), 0.1, TOWER_HEIGHT_M, [(-0.1, 0.1, 4.0, 5.0)])
    wall(stone, False, (-inner, inner), (inner, half), 0.1, TOWER_HEIGHT_M, [(-0.1, 0.1, 4.0, 5.0)])
    wall(stone, False, (-inner, inner), (-half, -inner), 0.1, TOWER_HEIGHT_M, [])
    top = TOWER_HEIGHT_M + 0.1
    box(stone, (-half - 0.3, top, -half - 0.3), (half + 0.3, top + 0.3, half + 0.3))
    for x in (-2.4, -0.8, 0.8, 2.4):
        for z in (-2.4, -0.8, 0.8, 2.4):
            if max(abs(x), abs(z)) > 2:
                box(stone, (x - 0.3, top + 0.3, z - 0.3), (x + 0.3, top + 1.1, z + 0.3))
    return [stone]


def tower_air():
    inner = TOWER_HALF_M - TOWER_WALL_M
    return (-inner, 0.1, -inner), (inner, TOWER_HEIGHT_M + 0.1, inner)


def pier():
    """Planks with gaps on beams and posts, from x = 0 out to sea along +x; y = 0 is the sea."""
    planks, half = Part("timber_grey"), PIER_WIDTH_M / 2
    for k in range(int(PIER_LENGTH_M / 0.3)):
        box(planks, (0.3 * k, PIER_DECK_M - 0.06, -half), (0.3 * k + 0.27, PIER_DECK_M, half))
    for z in (0.2 - half, half - 0.2):
        box(planks, (0, PIER_DECK_M - 0.26, z - 0.08), (PIER_LENGTH_M, PIER_DECK_M - 0.06, z + 0.08))
        for k in range(int(PIER_LENGTH_M / 4)):
            box(planks, (4 * k + 0.4, -9.0, z - 0.13), (4 * k + 0.66, PIER_DECK_M - 0.26, z + 0.13))
    return [planks]


POST_HEIGHT_M, FLAME_M = 3.8, 0.1
LAMP_UNDER_FLAME_M = 0.5  # where its point light is: nearer, it would light little but the flame


def lantern_post():
    """A post with an arm along +x, at whose end a flame burns under a small roof."""
    timber, flame = Part("timber"), Part("flame")
    box(timber, (-0.08, -0.8, -0.08), (0.08, POST_HEIGHT_M, 0.08))
    box(timber, (0.08, POST_HEIGHT_M - 0.16, -0.05), (0.75, POST_HEIGHT_M - 0.06, 0.05))
    x, y, _ = flame_of_post()
    box(timber, (x - 0.18, y + 0.24, -0.18), (x + 0.18, POST_HEIGHT_M - 0.16, 0.18))
    box(flame, (x - FLAME_M, y - FLAME_M, -FLAME_M), (x + FLAME_M, y + FLAME_M, FLAME_M))
    return [timber, flame]


def flame_of_post():
    return 0.55, POST_HEIGHT_M - 0.45, 0.0


def volume(low, high):
    """A closed box that marks space and has no material."""
    part = Part(None)
    box(part, low, high)
    return [part]
