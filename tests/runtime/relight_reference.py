"""The ambient light at a place, worked out a second time: from format/SPEC.md and the comments of the public headers, in
doubles, with nothing of our code. Sectors are what sector_file.read gives. Colours are [r, g, b]."""
import math

S, D = 1 / math.sqrt(6), 1 / math.sqrt(2)
U = 1 / math.sqrt(3)
BASIS = ((-S, -D, U), (-S, D, U), (2 * S, 0, U), (0, 0, -1))
Y0, Y1 = 0.5 / math.sqrt(math.pi), math.sqrt(3 / (4 * math.pi))
HEMISPHERE_FIT = ((8, 0, -4 * math.sqrt(3), 0), (0, 2, 0, 0), (-4 * math.sqrt(3), 0, 8, 0), (0, 0, 0, 2))
SKY_TO_COLOUR = (
    (0.222481148, -0.160289310, 0.215533855, -0.092543076),
    (0.222481148, 0.160289310, 0.215533855, -0.092543076),
    (0.222481148, 0, 0.215533855, 0.185086153),
    (0, 0, 0, 0),
)
OPEN_VISIBILITY = (1, 1, 1, 0)
CHANNELS, DIRECTIONS = range(3), range(4)
PARTS = ("sky_direct", "sky_bounce", "sun_bounce", "static", "local", "fallback")
INTERIOR_SOFT_M = 1
TILE_FADE_M = 16
DARK = (0, 0, 0)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def minus(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    length = math.hypot(*v)
    return [x / length for x in v]


def clamp(value, low, high):
    return max(low, min(high, value))


def spherical_harmonics(w):
    x, y, z = w
    return [Y0, Y1 * y, Y1 * z, Y1 * x]


def fit_to_hemisphere(integrals):
    return [dot(row, integrals) for row in HEMISPHERE_FIT]


def linear_sky(constant, slope):
    """The fit of one channel's radiance `constant + slope.w`, by its exact integrals over the upper hemisphere."""
    x, y, z = slope
    third = 2 * math.pi / 3  # of x^2, y^2 and z^2; of z it is pi, of 1 it is 2 pi
    return fit_to_hemisphere(
        [
            Y0 * (2 * math.pi * constant + math.pi * z),
            Y1 * third * y,
            Y1 * (math.pi * constant + third * z),
            Y1 * third * x,
        ]
    )


def constant_sky(radiance):
    return [linear_sky(channel, (0, 0, 0)) for channel in radiance]


def gradient_sky(zenith, horizon, sun_side, to_sun):
    side = unit(to_sun[:2]) if any(to_sun[:2]) else (0, 0)
    return [
        linear_sky(
            horizon[c] + sun_side[c] / 2,
            (sun_side[c] / 2 * side[0], sun_side[c] / 2 * side[1], zenith[c] - horizon[c]),
        )
        for c in CHANNELS
    ]


def sun_as_sh(mode, irradiance, to_sun):
    if to_sun[2] <= 0:
        return constant_sky(DARK)
    harmonics = spherical_harmonics(unit(to_sun))
    if mode == "accurate":
        harmonics = fit_to_hemisphere(harmonics)
    return [[channel * y for y in harmonics] for channel in irradiance]


def weights(mode, normal):
    if mode == "literal":
        cosines = [dot(normal, b) for b in BASIS]
        return [d * min(1, max(0, d)) for d in cosines[:3]] + [cosines[3] / 2 + 1 / 2]
    t = (1 + normal[2]) / (1 + 1 / math.sqrt(3))
    return [t / 3 + normal[0] * b[0] + normal[1] * b[1] for b in BASIS[:3]] + [1 - t]


class Light:
    """Sun, sky and light groups of a moment."""

    def __init__(self, mode="accurate", sky=None, sun=DARK, to_sun=(0, 0, 1), groups=None):
        self.mode = mode
        self.sky = sky or constant_sky(DARK)
        self.sun = sun_as_sh(mode, sun, to_sun)
        self.groups = groups or {}

    def sky_seen(self, visibility):
        """[b][c]"""
        rows = SKY_TO_COLOUR if self.mode == "accurate" else [spherical_harmonics(b) for b in BASIS]
        return [[visibility[b] * dot(rows[b], self.sky[c]) for c in CHANNELS] for b in DIRECTIONS]


class Lamp:
    def __init__(self, position, intensity):
        self.position, self.intensity = position, intensity


def bounced(transfer, light):
    return [[dot(transfer[c][b], light[c]) for c in CHANNELS] for b in DIRECTIONS]


def static_light(sector, probe, groups):
    """[b][c]"""
    lit = [(probe["static_irradiance"], (1, 1, 1))] if "static_irradiance" in probe else []
    if "light_groups" in probe:
        lit += [
            (irradiance, groups.get(name, DARK))
            for name, irradiance in zip(sector["light_groups"], probe["light_groups"], strict=True)
        ]
    return [
        [sum(irradiance[c][b] * factor[c] for irradiance, factor in lit) for c in CHANNELS]
        for b in DIRECTIONS
    ]


def distance_to_segment(p, a, b):
    along, to_p = minus(b, a), minus(p, a)
    length = dot(along, along)
    s = clamp(dot(to_p, along) / length, 0, 1) if length > 0 else 0
    return math.dist(to_p, [s * x for x in along])


def distance_to_triangle(p, corners):
    a, b, c = corners
    normal = cross(minus(b, a), minus(c, a))
    edges = ((a, b), (b, c), (c, a))
    area = math.hypot(*normal)
    if area > 0 and all(dot(cross(minus(end, start), minus(p, start)), normal) >= 0 for start, end in edges):
        return abs(dot(minus(p, a), normal)) / area
    return min(distance_to_segment(p, *edge) for edge in edges)


def solid_angle(p, corners):
    a, b, c = (minus(corner, p) for corner in corners)
    la, lb, lc = (math.hypot(*v) for v in (a, b, c))
    return 2 * math.atan2(
        dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    )


def signed_distance(mesh, p):
    """Above 0 inside."""
    triangles = [[mesh["vertices"][index] for index in indices] for indices in mesh["triangles"]]
    if not triangles:
        return -math.inf
    is_inside = round(sum(solid_angle(p, corners) for corners in triangles) / (4 * math.pi)) != 0
    distance = min(distance_to_triangle(p, corners) for corners in triangles)
    return distance if is_inside else -distance


def lies_near_bounds(mesh, p, margin):
    return all(
        min(vertex[axis] for vertex in mesh["vertices"]) - margin
        <= p[axis]
        <= max(vertex[axis] for vertex in mesh["vertices"]) + margin
        for axis in range(3)
    )


def sector_of(x, y):
    return math.floor(x / 64), math.floor(y / 64)


class Sectors:
    """Those that are loaded."""

    def __init__(self, sectors):
        self.by_index = {tuple(sector["sector"]): sector for sector in sectors}
        self.tiles = {index: sky_tile(sector) for index, sector in self.by_index.items()}
        self.outdoor_probes = {index: outdoor_probes(sector) for index, sector in self.by_index.items()}

    def cell(self, index, cx, cy, cz):
        """(sector index, probe) or None. The height index is clamped."""
        sector = self.by_index.get(index)
        if sector is None:
            return None
        probe = sector["grid"]["cells"][cx + 16 * cy + 256 * clamp(cz, 0, 15)]
        return (index, probe) if probe < len(sector["probes"]) else None

    def height_in_cells(self, index, z):
        grid = self.by_index[index]["grid"]
        return (z - grid["origin"][2]) / grid["cell"][2]

    def named_probe(self, place):
        x, y, z = place
        index = sector_of(x, y)
        if index not in self.by_index:
            return None
        column = [math.floor((at - 64 * i) / 4) for at, i in zip((x, y), index)]
        return self.cell(index, *column, math.floor(self.height_in_cells(index, z)))

    def nearest(self, place):
        return [(self.named_probe(place), 1)]

    def trilinear(self, place):
        """Shares by (sector index, probe), those of None the fallback's."""
        shares = []
        for index, column, share in columns_around(place):
            if index not in self.by_index:
                shares.append((None, share))
                continue
            height = self.height_in_cells(index, place[2]) - 1 / 2
            low = math.floor(height)
            for cz, part in ((low, 1 - (height - low)), (low + 1, height - low)):
                shares.append((self.cell(index, *column, cz), share * part))
        return [(named, share) for named, share in shares if share > 0]

    def outdoors(self, shares):
        """The same shares for a place that is in no interior."""
        return [
            (named and (named[0], self.outdoor_probes[named[0]][named[1]]), share) for named, share in shares
        ]

    def interior(self, place, soft_m=INTERIOR_SOFT_M):
        """(sector index, interior's index, share) or None; a softness of 0 asks for what holds the place."""
        found = []
        for index, sector in self.by_index.items():
            away = math.dist(place[:2], [64 * i + 32 for i in index])
            for n, mesh in enumerate(sector.get("interiors", [])):
                if not mesh["triangles"] or not lies_near_bounds(mesh, place, soft_m):
                    continue
                inside = signed_distance(mesh, place)
                share = clamp(1 / 2 + inside / soft_m, 0, 1) if soft_m > 0 else float(inside > 0)
                if share > 0:
                    order = (-share, index != sector_of(*place[:2]), away, index[1], index[0], n)
                    found.append((order, (index, n, share)))
        return min(found)[1] if found else None

    def interior_probe(self, index, n):
        return index, self.by_index[index]["interiors"][n]["probe"]

    def sky_factor(self, place):
        return sum(
            share * (tile_factor(self.tiles[index], column, place[2]) if index in self.tiles else 1)
            for index, column, share in columns_around(place)
        )


def columns_around(place):
    """The four columns of 4 m around a place: their sector, their place in it, and their share."""
    x, y = (at / 4 - 1 / 2 for at in place[:2])
    west, south = math.floor(x), math.floor(y)
    return [
        ((cx // 16, cy // 16), (cx % 16, cy % 16), sx * sy)
        for cx, sx in ((west, 1 - (x - west)), (west + 1, x - west))
        for cy, sy in ((south, 1 - (y - south)), (south + 1, y - south))
    ]


def outdoor_probes(sector):
    """What each probe is outdoors: itself, or the nearest that no interior holds or names."""
    meshes = sector.get("interiors", [])
    places = [probe["position"] for probe in sector["probes"]]
    indoors = {
        p
        for p, place in enumerate(places)
        if p in named_by_interiors(sector) or any(signed_distance(mesh, place) > 0 for mesh in meshes)
    }
    others = [p for p in range(len(places)) if p not in indoors]

    def nearest(p):
        return min(others, key=lambda q: (math.dist(places[p], places[q]), q))

    return [nearest(p) if p in indoors and others else p for p in range(len(places))]


def named_by_interiors(sector):
    return {mesh["probe"] for mesh in sector.get("interiors", [])}


def sky_tile(sector):
    """Of column (x, y) its visibility and height, None where no probe is named."""
    tile, indoors, cells = {}, named_by_interiors(sector), sector["grid"]["cells"]
    for column in range(256):
        named = {probe for probe in cells[column::256] if probe < len(sector["probes"])}
        candidates = named - indoors or named
        tile[column % 16, column // 16] = None
        if candidates:
            lowest = min(candidates, key=lambda p: (sector["probes"][p]["position"][2], p))
            probe = sector["probes"][lowest]
            code = math.floor(255 * sum(probe["sky_visibility"][:3]) / 3 + 1 / 2)
            tile[column % 16, column // 16] = (code / 255, probe["position"][2])
    return tile


def tile_factor(tile, column, z):
    if tile[column] is None:
        return 1
    visibility, height = tile[column]
    return 1 - (1 - visibility) * (1 - clamp((z - height) / TILE_FADE_M, 0, 1))


def split_lamp(sectors, lamp):
    """What the lamp becomes at the places of probes: (sector index, probe) -> share."""
    holds = sectors.interior(lamp.position, soft_m=0)
    if holds is not None:
        return {sectors.interior_probe(*holds[:2]): 1}
    shares = {}
    for named, share in sectors.outdoors(sectors.trilinear(lamp.position)):
        if named is not None:
            shares[named] = shares.get(named, 0) + share
    seen = {
        k: sum(share if j == k else share * sees(sectors, k, j) for j, share in shares.items())
        for k in shares
    }
    all_of_them = sum(shares.values())
    shares = {named: share * (seen[named] / all_of_them) ** 8 for named, share in shares.items()}
    total = sum(shares.values())
    return {named: share / total for named, share in shares.items()}


def bounce_between(sectors, receiver, source):
    """What a light at the source brings to the receiver, band 0 of all channels; None where the file does not say."""
    pairs = sectors.by_index[receiver[0]]["probes"][receiver[1]].get("local")
    if pairs is None:
        return None
    here = [pair for pair in pairs if (tuple(pair["sector"]), pair["probe"]) == source]
    return sum(pair["coefficients"][c][0] for pair in here for c in CHANNELS)


def sees(sectors, a, b):
    """How far two probes see the same space, 0 to 1."""
    found = [bounce_between(sectors, *pair) for pair in ((a, a), (b, b), (a, b), (b, a))]
    if None in found or found[0] * found[1] <= 0:
        return 1
    at, there = (sectors.by_index[index]["probes"][p]["position"] for index, p in (a, b))
    flat = (1 + math.dist(at, there) ** 2 / 4) ** -1.5
    return min(1, max(found[2], found[3]) / (math.sqrt(found[0] * found[1]) * flat / 4))


class Relighter:
    """Probes of a set of sectors under one light with its lamps."""

    def __init__(self, sectors, light, lamps=()):
        self.sectors, self.light = sectors, light
        self.lamp_shares = [(lamp, split_lamp(sectors, lamp)) for lamp in lamps]
        self.relit = {}

    def local(self, probe):
        """[b][c]"""
        colours = [[0.0] * 3 for _ in DIRECTIONS]
        for pair in probe.get("local", []):
            source = (tuple(pair["sector"]), pair["probe"])
            for lamp, shares in self.lamp_shares:
                if source not in shares:
                    continue
                at = self.sectors.by_index[source[0]]["probes"][source[1]]["position"]
                factor = shares[source] * pair_factor(at, lamp.position, probe["position"])
                for b in DIRECTIONS:
                    harmonics = spherical_harmonics(BASIS[b])
                    for c in CHANNELS:
                        colours[b][c] += factor * lamp.intensity[c] * dot(pair["coefficients"][c], harmonics)
        return colours

    def probe(self, named):
        """Of (sector index, probe), the parts as [b][c]."""
        if named not in self.relit:
            sector = self.sectors.by_index[named[0]]
            probe = sector["probes"][named[1]]
            self.relit[named] = {
                "sky_direct": self.light.sky_seen(probe["sky_visibility"]),
                "sky_bounce": bounced(probe["transfer"], self.light.sky),
                "sun_bounce": bounced(probe["transfer"], self.light.sun),
                "static": static_light(sector, probe, self.light.groups),
                "local": self.local(probe),
            }
        return self.relit[named]

    def open_sky(self):
        return {"fallback": self.light.sky_seen(OPEN_VISIBILITY)}

    def ambient(self, at, normal, sampling="trilinear", offset_m=0, interiors=True):
        """What a line of `drtv relight --json` holds, and whether anything in it was clamped."""
        normal = unit(normal)
        asked = [place + offset_m * n for place, n in zip(at, normal)]
        shares = getattr(self.sectors, sampling)(asked)
        if interiors:
            shares = self.sectors.outdoors(shares)
        interior = self.sectors.interior(asked) if interiors else None
        if interior is not None:
            index, n, inside = interior
            outside = [(named, (1 - inside) * share) for named, share in shares if inside < 1]
            shares = [(self.sectors.interior_probe(index, n), inside)] + outside
        named = self.sectors.named_probe(asked)

        weight = weights(self.light.mode, normal)
        colours = [[0.0] * 3 for _ in DIRECTIONS]
        parts = {part: [0.0] * 3 for part in PARTS}
        clamps = False
        for probe, share in shares:
            parts_of_probe = self.open_sky() if probe is None else self.probe(probe)
            if probe is None:
                share *= self.sectors.sky_factor(asked)
            for b in DIRECTIONS:
                for c in CHANNELS:
                    sum_of_parts = sum(part[b][c] for part in parts_of_probe.values())
                    clamps |= sum_of_parts < 0
                    colours[b][c] += share * max(0, sum_of_parts)
                    for name, part in parts_of_probe.items():
                        parts[name][c] += share * weight[b] * part[b][c]
        unclamped = [sum(weight[b] * colours[b][c] for b in DIRECTIONS) for c in CHANNELS]
        return {
            "at": list(at),
            "normal": normal,
            "status": self.status(shares, asked),
            "probe": named and {"sector": list(named[0]), "index": named[1]},
            "interior": interior and {"sector": list(interior[0]), "index": interior[1]},
            "basis_colours": colours,
            "parts": parts,
            "colour": [max(0, channel) for channel in unclamped],
        }, clamps or min(unclamped) < 0

    def status(self, shares, asked):
        known = {named is not None for named, _ in shares}
        if known == {True}:
            return "inside"
        if known == {True, False}:
            return "fading"
        return "no_probe" if sector_of(*asked[:2]) in self.sectors.by_index else "no_sector"


def pair_factor(source, lamp, receiver):
    """How much more the lamp brings than its share at the source, by what flat ground sends back of each."""

    def sent_back(at, height):
        return (height + 1) * (math.dist(at, receiver) ** 2 + 4 * height) ** -1.5

    height = max(0.25, 1 + lamp[2] - source[2])
    return min(3, sent_back(lamp, height) / sent_back(source, 1))
