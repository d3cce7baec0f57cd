"""drtv relight from outside: its numbers against a second implementation, and how it exits.
Usage: relight_tool_test.py DRTV GOLDEN_FOLDER"""
import json
import os
import random
import struct
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "format"))

import relight_reference as reference
import sector_file
from tool_case import (
    json_lines,
    GOLDEN,
    GOLDEN_1_1,
    GOLDEN_1_3,
    GOLDEN_FOLDER,
    INVALID,
    UNREADABLE,
    USAGE,
    Tool,
    drtv,
    golden,
    seal,
)

GOLDEN_1_2 = os.path.join(GOLDEN_FOLDER, "format_1_2.drtv")
POSITIONS, VISIBILITY, TRANSFER, GRID, STATIC, LOCAL, INTERIORS, GROUPS = 2, 3, 4, 5, 7, 8, 10, 11
UNITS = 1024  # a metre
NO_PROBE = 255
NEIGHBOURS = [(di, dj) for dj in (-1, 0, 1) for di in (-1, 0, 1)]

TOLERANCE, SUM_TOLERANCE = 2e-5, 1e-5  # of the largest number of a line
SHARE_ROUNDING = 2.0**-22  # shares are floats: of the largest number of all lines
WORLD = {(-1, 2): GOLDEN_1_3, (0, 2): GOLDEN_1_3, (-1, 3): GOLDEN_1_2, (0, 3): GOLDEN_1_1, (-2, 2): GOLDEN}
LOW, HIGH = (-140, 116, 4), (76, 268, 34)  # of the places asked: the world and some metres around it
CORNER = (0, 192, 12)  # of the sectors that hold interiors, and of one without
SKY = {"zenith": (2, 4, 9), "horizon": (5, 6, 8), "sun_side": (3, 2, 1)}
SUN, HIGH_SUN, LOW_SUN, NIGHT_SUN = (9, 8.5, 7), (1, -2, 3), (-3, 0.5, 0.25), (2, 1, -0.5)
GROUP_COLOURS = {"lanterns": (1, 0.5, 0.25), "nächtliche Fenster": (0.5, 2, 3)}


def sections_of(data):
    (count,) = struct.unpack_from("<I", data, 12)
    entries = (struct.unpack_from("<HHIII", data, at) for at in range(64, 64 + 32 * count, 32))
    return {kind: offset for kind, _, _, offset, _ in entries}


def shuffled_sector(path, index, rng):
    """The file as another sector's, with other numbers wherever it lights."""
    data = golden(path)
    probes = data[28]
    at = sections_of(data)
    struct.pack_into("<2i", data, 16, *index)
    for p in range(probes):
        struct.pack_into(
            "<3H", data, at[POSITIONS] + 8 * p, *(rng.randrange(65536) for _ in range(2)), rng.randrange(8192)
        )
        struct.pack_into("<3h", data, at[VISIBILITY] + 8 * p, *(rng.randrange(32768) for _ in range(3)))
        for row in range(12):
            codes = rng.randrange(9000), *(rng.randint(-9000, 9000) for _ in range(3))
            struct.pack_into("<4h", data, at[TRANSFER] + 96 * p + 8 * row, *codes)
    shuffle_grid(data, at[GRID], probes, rng)
    if STATIC in at:
        shuffle_irradiance(data, at[STATIC], probes, rng)
    if LOCAL in at:
        shuffle_local(data, at[LOCAL], probes, rng)
    if INTERIORS in at:
        shuffle_interiors(data, at[INTERIORS], rng)
        put_in_interiors(data, at[POSITIONS], index)
    if GROUPS in at:
        groups = data[at[GROUPS]]
        shuffle_irradiance(data, at[GROUPS] + 16 + 64 * groups, probes * groups, rng)
    return seal(data)


def shuffle_grid(data, at, probes, rng):
    struct.pack_into("<iI", data, at, rng.randint(4 * UNITS, 12 * UNITS), rng.randint(UNITS // 2, 2 * UNITS))
    for cell in range(4096):
        data[at + 16 + cell] = rng.choice([*range(probes)] * 3 + [probes, NO_PROBE])
    hole_x, hole_y = (rng.randint(0, 11) for _ in range(2))
    hole = [hole_x + x + 16 * (hole_y + y) for x in range(5) for y in range(5)]
    for column in hole + rng.sample(range(256), 20):
        data[at + 16 + column : at + 16 + 4096 : 256] = bytes([NO_PROBE]) * 16


def shuffle_irradiance(data, at, probes, rng):
    struct.pack_into(f"<{12 * probes}h", data, at, *(rng.randrange(32768) for _ in range(12 * probes)))
    struct.pack_into(f"<{probes}b", data, at + 24 * probes, *(rng.randint(-4, 0) for _ in range(probes)))


def shuffle_local(data, at, probes, rng):
    """Of as many sources and pairs as before."""
    section = bytes(data[at:])
    sources, mask_bytes, pairs, receivers_at, masks_at, codes_at = sector_file.local_transfer_layout(
        section, probes
    )
    near = [(di, dj, probe) for di, dj in NEIGHBOURS for probe in range(3)]
    rng.shuffle(near)
    near.sort(key=lambda source: source[:2] != (0, 0))
    far = [(0, 1, probe) for probe in range(3, 255)]
    for s, source in enumerate((near + far)[:sources]):
        struct.pack_into("<bbBb", data, at + 16 + 4 * s, *source, rng.randint(-1, 1))
    for p in range(probes):
        data[at + receivers_at + 8 * p + 4] = rng.randint(0, 1)
        mask_at = masks_at + mask_bytes * p
        bits = int.from_bytes(section[mask_at : mask_at + mask_bytes], "little").bit_count()
        # With itself, so that a lamp's shares know which of the others it sees.
        itself = near.index((0, 0, p))
        others = [s for s in range(min(sources, len(near))) if s != itself]
        mask = sum(1 << s for s in [itself, *rng.sample(others, bits - 1)])
        data[at + mask_at : at + mask_at + mask_bytes] = mask.to_bytes(mask_bytes, "little")
    for row in range(3 * pairs):
        codes = rng.randrange(30000), *(rng.randint(-30000, 30000) for _ in range(3))
        struct.pack_into("<4h", data, at + codes_at + 8 * row, *codes)


def shuffle_interiors(data, at, rng):
    """All around one corner of four sectors, 2.5 m of which all of them hold."""
    for n, shift in enumerate((0, 4)):
        low_corner = (corner - rng.uniform(*back) for corner, back in zip(CORNER, ((3, 5), (3, 5), (1, 3))))
        origin = [int(UNITS * metres) for metres in low_corner]
        struct.pack_into("<3i2B", data, at + 16 + 32 * n, *origin, shift, 2)


def put_in_interiors(data, at, index):
    """A probe that no interior names, 0.5 m from the corner that all of them hold."""
    z_origin, z_shift = struct.unpack_from("<i", data, 24)[0], data[30]
    xy = [
        round((corner + (0.5 if 64 * i == corner else -0.5) - 64 * i) * UNITS)
        for corner, i in zip(CORNER, index)
    ]
    z = (round((CORNER[2] + 0.2) * UNITS) - z_origin) >> z_shift
    struct.pack_into("<3H", data, at, *xy, z)


def random_normal(rng):
    return [rng.gauss(0, 1) for _ in range(3)]


def random_places(rng, sectors, count):
    """Half of them anywhere, others near the borders of sectors, and in interiors and around them."""
    meshes = [mesh["vertices"] for sector in sectors for mesh in sector.get("interiors", [])]
    for n in range(count):
        place = [rng.uniform(*range_) for range_ in zip(LOW, HIGH)]
        if n % 4 == 0:
            place[rng.randrange(2)] = 64 * rng.randint(-2, 3) + rng.uniform(-3, 3)
        elif n % 4 == 1:
            mesh = rng.choice(meshes)
            place = [rng.uniform(min(axis) - 0.6, max(axis) + 0.6) for axis in zip(*mesh)]
        yield place, random_normal(rng)


def numbers(values):
    return ",".join(repr(value) for value in values)


def as_lines(places):
    return "".join(
        json.dumps({"at": list(at), "normal": list(normal)}) + "\n" for at, normal in places
    ).encode()


def flat(value):
    return [number for element in value for number in flat(element)] if isinstance(value, list) else [value]


def numbers_of(line):
    return flat([line["basis_colours"], line["colour"], *line["parts"].values()])


class Numbers(Tool):
    @classmethod
    def setUpClass(cls):
        rng = random.Random(1)
        cls.files = {index: bytes(shuffled_sector(path, index, rng)) for index, path in WORLD.items()}
        cls.parsed = [sector_file.read(data) for data in cls.files.values()]
        cls.sectors = reference.Sectors(cls.parsed)
        cls.lamps = [
            reference.Lamp(
                [rng.uniform(*range_) for range_ in zip(LOW, HIGH)], [rng.uniform(1, 9) for _ in range(3)]
            )
            for _ in range(10)
        ]
        vertices = cls.sectors.by_index[-1, 2]["interiors"][0]["vertices"]
        cls.indoor_lamp = reference.Lamp([sum(axis) / len(axis) for axis in zip(*vertices)], (2, 4, 6))
        cls.all_lamps = [*cls.lamps, cls.indoor_lamp]

    def setUp(self):
        super().setUp()
        for (i, j), data in self.files.items():
            self.write(f"world/sector_{i}_{j}.drtv", data)

    def asked(self, places, *arguments):
        unknown = any("of no sector" in argument for argument in arguments)
        stdout = self.expect(
            0,
            "relight",
            self.path("world"),
            "--json",
            "--points",
            "-",
            *arguments,
            input=as_lines(places),
            err='has a light group "of no sector"' if unknown else "",
        )
        return [json.loads(line) for line in stdout.splitlines()]

    def assert_equal_to_reference(self, line, expected, clamps, rounding):
        self.assertEqual(list(line), list(expected))
        self.assertEqual(list(line["parts"]), list(expected["parts"]))
        for name in ("status", "probe", "interior"):
            self.assertEqual(line[name], expected[name], name)
        self.assertEqual(line["at"], expected["at"])
        for value, expected_value in zip(line["normal"], expected["normal"], strict=True):
            self.assertAlmostEqual(value, expected_value, delta=1e-6)
        delta = TOLERANCE * max(map(abs, numbers_of(expected))) + rounding
        for name, value, expected_value in [
            ("basis_colours", line["basis_colours"], expected["basis_colours"]),
            ("colour", line["colour"], expected["colour"]),
            *((part, line["parts"][part], expected["parts"][part]) for part in reference.PARTS),
        ]:
            for number, expected_number in zip(flat(value), flat(expected_value), strict=True):
                self.assertAlmostEqual(number, expected_number, delta=delta, msg=name)
        if not clamps:
            for c, channel in enumerate(line["colour"]):
                total = sum(part[c] for part in line["parts"].values())
                self.assertAlmostEqual(total, channel, delta=SUM_TOLERANCE * max(map(abs, numbers_of(line))))

    def compare(self, light, *arguments, lamps=(), seed=0, count=160, **options):
        """Options are those of Relighter.ambient. Gives the lines."""
        relighter = reference.Relighter(self.sectors, light, lamps)
        places = list(random_places(random.Random(seed), self.parsed, count))
        arguments = ["--mode", light.mode, *arguments]
        if "sampling" in options:
            arguments += ["--by", options["sampling"]]
        return self.compare_places(places, relighter, arguments, options)

    def compare_places(self, places, relighter, arguments, options):
        lines = self.asked(places, *arguments)
        expected = [relighter.ambient(*place, **options) for place in places]
        rounding = SHARE_ROUNDING * max(abs(number) for line, _ in expected for number in numbers_of(line))
        for line, (expected_line, clamps), place in zip(lines, expected, places, strict=True):
            with self.subTest(arguments=arguments, place=place):
                self.assert_equal_to_reference(line, expected_line, clamps, rounding)
        return lines

    def compare_in_all_ways(self, make_light, *arguments, lamps=(), seed):
        for mode in ("accurate", "literal"):
            for sampling in ("trilinear", "nearest"):
                self.compare(make_light(mode), *arguments, lamps=lamps, seed=seed, sampling=sampling)

    def test_sky_of_one_radiance(self):
        def light(mode):
            return reference.Light(mode, sky=reference.constant_sky((1, 2, 4)))

        self.compare_in_all_ways(light, "--sky", "1,2,4", seed=1)

    def test_sky_of_three_colours_and_suns(self):
        for seed, to_sun in enumerate((HIGH_SUN, LOW_SUN, NIGHT_SUN), start=2):

            def light(mode):
                return reference.Light(mode, reference.gradient_sky(**SKY, to_sun=to_sun), SUN, to_sun)

            self.compare_in_all_ways(
                light,
                "--sky-colours=" + numbers(flat([list(colour) for colour in SKY.values()])),
                "--sun-direction=" + numbers(to_sun),
                "--sun=" + numbers(SUN),
                seed=seed,
            )

    def test_sun_alone(self):
        light = reference.Light("accurate", sun=SUN, to_sun=LOW_SUN)
        self.compare(light, "--sun-direction=" + numbers(LOW_SUN), "--sun=" + numbers(SUN), seed=5)

    def test_sky_of_three_colours_without_a_sun_has_no_side(self):
        light = reference.Light("accurate", reference.gradient_sky(**SKY, to_sun=(0, 0, 1)))
        self.compare(
            light, "--sky-colours=" + numbers(flat([list(colour) for colour in SKY.values()])), seed=6
        )

    def test_lamps(self):
        arguments = ["--light=" + numbers([*lamp.position, *lamp.intensity]) for lamp in self.lamps]
        self.compare_in_all_ways(reference.Light, *arguments, lamps=self.lamps, seed=7)

    def test_lamp_in_an_interior(self):
        self.assertEqual(list(reference.split_lamp(self.sectors, self.indoor_lamp).values()), [1])
        argument = "--light=" + numbers([*self.indoor_lamp.position, *self.indoor_lamp.intensity])
        self.compare_in_all_ways(reference.Light, argument, lamps=[self.indoor_lamp], seed=13)

    def test_lamp_beside_an_interior_stands_outside(self):
        meshes = [mesh["vertices"] for sector in self.parsed for mesh in sector.get("interiors", [])]
        mesh = min(meshes, key=min)
        west, _, _ = min(mesh)
        _, *middle = (sum(axis) / len(axis) for axis in zip(*mesh))
        lamp = reference.Lamp((west - 0.25, *middle), (2, 4, 6))
        self.assertIsNotNone(self.sectors.interior(lamp.position))
        self.assertIsNone(self.sectors.interior(lamp.position, soft_m=0))
        argument = "--light=" + numbers([*lamp.position, *lamp.intensity])
        self.compare_in_all_ways(reference.Light, argument, lamps=[lamp], seed=14)

    def test_of_interiors_that_hold_a_place_the_right_one_lights_it(self):
        x, y, z = CORNER
        diagonal = [((x + n / 8, y + n / 8, z), (0, 0, 1)) for n in range(-20, 21)]
        border = [((x, y - n / 8, z), (0, 0, 1)) for n in range(21)]
        relighter = reference.Relighter(self.sectors, reference.Light())
        lines = self.compare_places(diagonal + border, relighter, [], {})
        chosen = {tuple(line["interior"]["sector"]) for line in lines}
        self.assertEqual(chosen, {(-1, 2), (0, 2)})

    def test_light_groups(self):
        def light(mode):
            return reference.Light(mode, groups=GROUP_COLOURS)

        arguments = [f"--group={name}={numbers(colour)}" for name, colour in GROUP_COLOURS.items()]
        self.compare_in_all_ways(light, *arguments, seed=8)

    def test_light_groups_that_are_not_named_are_dark(self):
        groups = {"lanterns": (1, 1, 1), "of no sector": (5, 5, 5)}
        arguments = [f"--group={name}={numbers(colour)}" for name, colour in groups.items()]
        self.compare(reference.Light(groups=groups), *arguments, seed=9)
        self.compare(reference.Light(), seed=9)

    def everything(self, mode="accurate"):
        light = reference.Light(
            mode, reference.gradient_sky(**SKY, to_sun=HIGH_SUN), SUN, HIGH_SUN, groups=GROUP_COLOURS
        )
        return light, [
            "--sky-colours=" + numbers(flat([list(colour) for colour in SKY.values()])),
            "--sun-direction=" + numbers(HIGH_SUN),
            "--sun=" + numbers(SUN),
            *("--light=" + numbers([*lamp.position, *lamp.intensity]) for lamp in self.all_lamps),
            *(f"--group={name}={numbers(colour)}" for name, colour in GROUP_COLOURS.items()),
        ]

    def test_offset_along_the_normal(self):
        light, arguments = self.everything()
        for sampling in ("trilinear", "nearest"):
            self.compare(
                light,
                *arguments,
                "--offset=2.5",
                lamps=self.all_lamps,
                seed=10,
                sampling=sampling,
                offset_m=2.5,
            )

    def test_all_at_once_is_what_its_places_show(self):
        for mode in ("accurate", "literal"):
            light, arguments = self.everything(mode)
            lines = self.compare(light, *arguments, lamps=self.all_lamps, seed=11, count=400)
            self.assertEqual(
                {line["status"] for line in lines}, {"inside", "fading", "no_sector", "no_probe"}
            )
            for name in ("probe", "interior"):
                self.assertGreater(sum(line[name] is not None for line in lines), 40)
                self.assertGreater(sum(line[name] is None for line in lines), 40)
            self.assertTrue(
                all(any(map(any, (line["parts"][part] for line in lines))) for part in reference.PARTS)
            )

    def test_without_interiors(self):
        light, arguments = self.everything()
        self.compare(light, *arguments, "--no-interiors", lamps=self.all_lamps, seed=12, interiors=False)

    def test_borders_of_cells_belong_to_the_cell_that_begins_there(self):
        places = [
            ((4 * x, 4 * y, self.sectors.by_index[-1, 2]["grid"]["origin"][2]), (0, 0, 1))
            for x in range(-20, 4)
            for y in range(30, 52, 3)
        ]
        light = reference.Light(sky=reference.constant_sky((1, 2, 4)))
        relighter = reference.Relighter(self.sectors, light)
        for sampling in ("trilinear", "nearest"):
            arguments = ["--sky", "1,2,4", "--by", sampling]
            self.compare_places(places, relighter, arguments, {"sampling": sampling})

    def test_far_away_there_is_the_open_sky(self):
        places = [
            ((x, y, z), (0, 0, 1)) for x in (1e9, -1e300, 0) for y in (-1e9, 1e300) for z in (-1e300, 9, 1e9)
        ]
        light = reference.Light(sky=reference.constant_sky((1, 2, 4)))
        relighter = reference.Relighter(self.sectors, light)
        for sampling in ("trilinear", "nearest"):
            arguments = ["--sky", "1,2,4", "--by", sampling]
            for line in self.compare_places(places, relighter, arguments, {"sampling": sampling}):
                self.assertEqual((line["status"], line["probe"], line["interior"]), ("no_sector", None, None))
                for channel, expected in zip(line["colour"], (1, 2, 4)):
                    self.assertAlmostEqual(channel, expected, delta=TOLERANCE * 4)

    def test_one_place_is_the_same_as_a_line_of_many(self):
        place = ((-20.5, 150.25, 12.125), (0.5, -0.25, 1))
        at, normal = map(numbers, place)
        stdout = self.expect(
            0, "relight", self.path("world"), "--at=" + at, "--normal=" + normal, "--sky=1,2,4", "--json"
        )
        self.assertEqual([json.loads(stdout)], self.asked([place], "--sky=1,2,4"))

    def test_points_may_stand_in_a_file(self):
        place = ((-20.5, 150.25, 12.125), (0.5, -0.25, 1))
        points = self.write("points.json", as_lines([place]))
        stdout = self.expect(0, "relight", self.path("world"), "--json", "--points", points, "--sky=1,2,4")
        self.assertEqual([json.loads(stdout)], self.asked([place], "--sky=1,2,4"))

    def test_no_points_print_nothing(self):
        self.assertEqual(self.asked([]), [])


class Usage(Tool):
    PLACE = ("--at=-20,150,12", "--normal=0,0,1")

    def setUp(self):
        super().setUp()
        self.world = os.path.dirname(self.write("world/a.drtv", golden(GOLDEN_1_3)))

    def assert_refused(self, exit_code, words, *arguments, points=None):
        with self.subTest(arguments=arguments, points=points):
            result = drtv("relight", *arguments, input=points)
            self.assertEqual(result.returncode, exit_code, result.stderr)
            self.assertEqual(result.stdout, b"")
            stderr = json_lines.read("drtv", ("relight", *arguments), "", result.stderr.decode())
            self.assertRegex(stderr, r"\Adrtv: [^\n]+\n\Z")
            self.assertIn(words, stderr)

    def test_options_that_do_not_fit_are_refused(self):
        for words, *arguments in [
            ("--at with --normal, or --points, is required",),
            ("--at requires --normal", "--at=1,2,3"),
            ("--normal requires --at", "--normal=0,0,1"),
            ("--at excludes --points", *self.PLACE, "--points=-"),
            ("--time excludes --sky", *self.PLACE, "--time=12:00", "--sky=1,1,1"),
            ("--time excludes --sun-direction", *self.PLACE, "--time=12:00", "--sun-direction=0,0,1"),
            ("--gradients goes with --time", *self.PLACE, "--gradients=day.json"),
            ("--sun requires --sun-direction", *self.PLACE, "--sun=1,1,1"),
            ("--sky excludes --sky-colours", *self.PLACE, "--sky=1,1,1", "--sky-colours=1,1,1,1,1,1,1,1,1"),
            ('"there" is one argument too many', *self.PLACE, "there"),
        ]:
            self.assert_refused(USAGE, words, self.world, *arguments)
        self.assert_refused(USAGE, "DIR is required", *self.PLACE)

    def test_values_that_are_none_are_refused(self):
        for words, *arguments in [
            ('--at takes x,y,z, not "1,2"', "--at=1,2", "--normal=0,0,1"),
            ('--at takes x,y,z, not "1,2,nan"', "--at=1,2,nan", "--normal=0,0,1"),
            ('not "0,0,0"', "--at=1,2,3", "--normal=0,0,0"),
            ('--time takes a time of day such as 14:00, not "25:00"', *self.PLACE, "--time=25:00"),
            ('--light takes x,y,z,r,g,b, not "1,2,3,4,5"', *self.PLACE, "--light=1,2,3,4,5"),
            ('--group takes NAME=r,g,b, not "x"', *self.PLACE, "--group=x"),
            ('--group takes NAME=r,g,b, not "=1,1,1"', *self.PLACE, "--group==1,1,1"),
            ('--mode: takes one of literal, accurate, not "bad"', *self.PLACE, "--mode=bad"),
            ('--by: takes one of nearest, trilinear, volume, not "bad"', *self.PLACE, "--by=bad"),
            ("--sun-direction has no length", *self.PLACE, "--sun-direction=0,0,0"),
            ("--sky takes light of at least 0", *self.PLACE, "--sky=-1,1,1"),
            ("--offset: takes a number", *self.PLACE, "--offset=nan"),
        ]:
            self.assert_refused(USAGE, words, self.world, *arguments)

    def test_wrong_line_of_points_is_named(self):
        right = b'{"at":[1,2,3],"normal":[0,0,1]}\n'
        for words, wrong in [
            ("it must be a JSON object", b"here"),
            ("it must be a JSON object", b"[1,2,3]"),
            ("it must be a JSON object", right.strip() + b" " + right),
            ('"normal"', b'{"at":[1,2,3]}'),
            ('"at"', b'{"normal":[0,0,1]}'),
            ('"at" must be three numbers', b'{"at":[1,2],"normal":[0,0,1]}'),
            ('"normal" has no length', b'{"at":[1,2,3],"normal":[0,0,0]}'),
            ('"colour" is unknown', b'{"at":[1,2,3],"normal":[0,0,1],"colour":1}'),
        ]:
            arguments = (self.world, "--points=-", "--json")
            self.assert_refused(USAGE, f"line 1: {words}", *arguments, points=wrong)
            self.assert_refused(USAGE, f"line 3: {words}", *arguments, points=2 * right + wrong)

    def test_files_that_cannot_be_read_exit_2(self):
        self.write("empty/readme.txt", b"")
        for words, folder, *arguments in [
            ("does not exist", "nothing", *self.PLACE),
            ("holds no .drtv file", "empty", *self.PLACE),
            ("cannot read", "world", "--points=" + self.path("points.json")),
            ("cannot read", "world", *self.PLACE, "--time=12:00", "--gradients=" + self.path("day.json")),
        ]:
            self.assert_refused(UNREADABLE, words, self.path(folder), *arguments)

    def test_invalid_files_exit_3(self):
        day = {"sun": [{"time": "12:00", "colour": [1, 2]}], "zenith": [], "horizon": []}
        for words, text in (("it is no JSON", "12:00"), ("sun[0].colour", json.dumps(day))):
            gradients = self.write("day.json", text.encode())
            arguments = (*self.PLACE, "--time=12:00", "--gradients", gradients)
            self.assert_refused(INVALID, words, self.world, *arguments)
        self.broken("world/broken.drtv")
        self.assert_refused(INVALID, "broken.drtv", self.world, *self.PLACE)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
