"""`bakerd render` from outside: its pictures, what it prints, and how it exits.
Usage: render_test.py BAKERD DRTV WRITE_YARD"""
import base64
import json
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "format"))
sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

import json_lines
import png_file

BAKERD, DRTV, WRITE_YARD = sys.argv[1:4]
USAGE, UNREADABLE, INVALID = 1, 2, 3
SOUTH = ("--camera", "26,2,3", "--look", "26,32,2")  # between a red wall and a blue one
SMALL = ("--size", "160x90")
KINDS = "all ambient sky_direct sky_bounce sun_bounce static local fallback tile cells leaks probes weights age clipped"


def filmic(x):
    x = max(x, 0)
    return min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1)


def srgb(linear):
    return 255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055)


def program(path, *arguments, text=None):
    return subprocess.run([path, *arguments], capture_output=True, text=True, input=text, check=False)


class Render(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = tempfile.mkdtemp()
        subprocess.run([WRITE_YARD, cls.root], check=True)
        cls.sectors, cls.map = os.path.join(cls.root, "sectors"), os.path.join(cls.root, "yard.glb")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def setUp(self):
        self.folder = tempfile.mkdtemp(dir=self.root)

    def path(self, name):
        return os.path.join(self.folder, name)

    def render(self, *arguments, sectors=None, map=None):
        return program(BAKERD, "render", sectors or self.sectors, "--map", map or self.map, *arguments)

    def drawn(self, *arguments, name="picture.png"):
        out = self.path(name)
        run = self.render(*arguments, "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        self.told = run.stdout
        return png_file.read(out)

    def refused(self, code, sentence, *arguments, **where):
        run = self.render(*arguments, **where)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        self.assertTrue(run.stderr.startswith("bakerd: "), run.stderr)
        self.assertIn(sentence, run.stderr)
        self.assertEqual(os.listdir(self.folder), [])


class Pictures(Render):
    def test_ambient_is_what_drtv_relights(self):
        exposure, count = -2, 400
        rng = random.Random(5)
        pixels = [(rng.randrange(1, 159), rng.randrange(30, 89)) for _ in range(count)]
        picks = [word for x, y in pixels for word in ("--pick", f"{x},{y}")]
        light = ("--time", "14:00", "--light", "30,26,2.5,40,30,20", "--group", "lanterns=1,1,1")
        picture = self.drawn(*SOUTH, *SMALL, *light, "--show", "ambient", "--exposure", str(exposure), *picks)
        objects = [line for line in self.told.splitlines() if line.startswith("{")]
        json_lines.check("bakerd", "render", "\n".join(objects))
        surfaces = [json.loads(line) for line in objects]
        surfaces = [surface for surface in surfaces if "at" in surface]
        points = "".join(json.dumps({"at": s["at"], "normal": s["normal"]}) + "\n" for s in surfaces)
        relit = program(
            DRTV,
            "relight",
            self.sectors,
            "--points",
            "-",
            "--by",
            "volume",
            "--camera",
            "26,2,3",
            *light,
            "--json",
            text=points,
        )
        self.assertEqual(relit.returncode, 0, relit.stderr)
        json_lines.check("drtv", "relight", relit.stdout)
        compared = 0
        for surface, line in zip(surfaces, relit.stdout.splitlines(), strict=True):
            colour = json.loads(line)["colour"]
            x, y = (int(n) for n in surface["pixel"])
            shown = picture.pixel(x, y)
            around = [picture.pixel(x + dx, y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
            smooth = all(abs(a - b) <= 6 for other in around for a, b in zip(shown, other))
            for channel in range(3):
                self.assertLess(abs(colour[channel] - surface["ambient"][channel]), 1e-3 * (1 + max(colour)))
                if smooth:
                    expected = srgb(filmic(colour[channel] * 2**exposure))
                    self.assertLessEqual(abs(shown[channel] - expected), 1, (x, y, colour))
            compared += smooth
        self.assertGreaterEqual(compared, 100)

    def test_every_kind_of_picture_shows_something_of_its_own(self):
        seen = set()
        for kind in KINDS.split():
            picture = self.drawn(
                *SOUTH, *SMALL, "--time", "12:00", "--light", "30,26,2.5,400,300,200",
                "--group", "lanterns=1,1,1", "--show", kind, "--exposure", "-3", name=kind + ".png",
            )  # fmt: skip
            rows = b"".join(picture.rows)
            if kind not in ("age", "fallback"):  # may well be of one colour so near by
                self.assertGreater(len(set(rows)), 8, kind)
            seen.add(rows)
        self.assertEqual(len(seen), len(KINDS.split()))

    def test_same_bytes_again_and_with_other_threads(self):
        pictures = []
        for threads in ("1", "2", "7"):
            self.drawn(*SOUTH, *SMALL, "--threads", threads, name=threads + ".png")
            with open(self.path(threads + ".png"), "rb") as file:
                pictures.append(file.read())
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[0], pictures[2])

    def test_a_sheet_over_the_day_has_one_exposure(self):
        picture = self.drawn(*SOUTH, *SMALL, "--times", "12:00,18:00,23:00")
        self.assertEqual((picture.width, picture.height), (320, 180))
        noon = self.drawn(*SOUTH, *SMALL, "--time", "12:00")
        # Below the caption they are the same.
        for y in range(40, 90):
            self.assertEqual(picture.rows[y][: 3 * 160], noon.rows[y])
        mean = (
            lambda x, y: sum(sum(picture.pixel(x + n, y + m)) for n in range(100) for m in range(40)) / 12000
        )
        self.assertGreater(mean(30, 45), 60)
        self.assertLess(mean(30, 135), 20, "night is night")
        bright = self.drawn(*SOUTH, *SMALL, "--time", "23:00", "--exposure", "auto")
        self.assertGreater(max(bright.rows[80]), 40)

    def test_picks_of_several_hours(self):
        run = self.render(*SOUTH, *SMALL, "--times", "06:30,12:00", "--pick", "80,80", "--pick", "3,3")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        json_lines.check("bakerd", "render", run.stdout)
        lines = [json.loads(line) for line in run.stdout.splitlines()]
        self.assertEqual([(line["time"], line["pixel"]) for line in lines],
                         [(time, pixel) for time in ("06:30", "12:00") for pixel in ([80, 80], [3, 3])])  # fmt: skip
        self.assertLess(lines[0]["ambient"][2], lines[2]["ambient"][2])

    def test_from_far_above_probes_are_spheres_too(self):
        picture = self.drawn("--top", "--region", "0,0,64,64", "--size", "64x64", "--show", "probes")
        # Sky blue on green ground.
        pixels = [picture.pixel(x, y) for x in range(64) for y in range(64)]
        self.assertGreater(sum(blue > 0.8 * green > 20 for _, green, blue in pixels), 200)

    def test_interiors_can_be_left_out(self):
        inside = (
            "--camera",
            "47,11.5,1.5",
            "--look",
            "44,8,1.2",
            *SMALL,
            "--exposure",
            "0",
            "--show",
            "ambient",
        )
        mean = lambda picture: sum(map(sum, picture.rows)) / (3 * 160 * 90)
        self.assertLess(mean(self.drawn(*inside)) + 10, mean(self.drawn(*inside, "--no-interiors")))

    def test_from_above_the_picture_knows_its_world(self):
        picture = self.drawn("--top", "--size", "400x200")
        x0, y0, x1, y1 = picture.world()
        self.assertLessEqual(x0, 0)
        self.assertGreaterEqual(x1, 192)
        self.assertAlmostEqual((x1 - x0) / (y1 - y0), 2, places=4)
        red, blue, green = picture.at(11.5, 40), picture.at(40.5, 40), picture.at(100, 10)
        self.assertGreater(red[0], max(red[1:]) + 30)
        self.assertGreater(blue[2], max(blue[:2]) + 30)
        self.assertGreater(green[1], max(green[0], green[2]) + 30)
        # And lies under probes.
        out = self.path("under.png")
        run = program(DRTV, "preview", self.sectors, "--under", self.path("picture.png"), "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        preview = png_file.read(out)
        places = [(x + 0.3, y + 0.3) for x in range(2, 190, 9) for y in range(3, 62, 7)]
        same = sum(preview.at(*place) == picture.at(*place) for place in places)
        self.assertGreater(same, 0.15 * len(places), "the rest lies under probes, 4 m apart and as wide")
        self.assertLess(same, len(places))

    def test_a_part_of_the_world_from_above(self):
        picture = self.drawn("--top", "--region", "0,0,32,16", "--size", "64x32")
        self.assertEqual(picture.texts["drtv:world"], "0,0,32,16")

    def test_without_a_camera_a_rule_chooses_and_says_so(self):
        self.drawn(*SMALL)
        words = self.told.replace(",  ", " ").split()
        camera, look = (words[words.index(option) + 1].rstrip(",") for option in ("--camera", "--look"))
        self.drawn(*SMALL, "--camera", camera, "--look", look, name="again.png")
        with open(self.path("picture.png"), "rb") as one, open(self.path("again.png"), "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_a_hole_in_the_set_is_lit_by_the_sky(self):
        few = self.path("few")
        shutil.copytree(self.sectors, few)
        os.remove(os.path.join(few, "sector_0_0.drtv"))
        out = self.path("hole.png")
        run = self.render(*SOUTH, *SMALL, "--show", "fallback", "--out", out, sectors=few)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        red, green, _ = png_file.read(out).pixel(80, 80)
        self.assertGreater(red, 100)
        self.assertEqual(green, 0)


class Comparison(Render):
    # Percent of the mean, by part: a quarter above what was measured (docs/measurements.md).
    DAY = {"sky_direct": 7.5, "sky_bounce": 2, "sun_bounce": 19, "all": 21, "storage": 12}
    DAY |= {"interpolation": 18, "shading": 12}
    NIGHT = {"sky_direct": 5, "static": 17, "all": 18, "storage": 1, "interpolation": 16, "shading": 24}

    def compared(self, *light, paths=256):
        self.picture = self.drawn(
            *SOUTH, "--size", "96x54", *light, "--compare", "--paths", str(paths), "--exposure", "-3"
        )
        self.assertEqual((self.picture.width, self.picture.height), (288, 54))
        rows = [line.split() for line in self.told.splitlines()]
        names = (*KINDS.split(), "storage", "interpolation", "shading")
        return {words[0]: float(words[-1]) for words in rows if len(words) in (3, 4) and words[0] in names}

    def mean(self, part):
        return sum(sum(row[3 * 96 * part : 3 * 96 * (part + 1)]) for row in self.picture.rows) / (288 * 54)

    def test_errors_by_part_do_not_grow(self):
        for limits, light in (
            (self.DAY, ("--time", "10:00")),
            (self.NIGHT, ("--sky", "0.01,0.01,0.02", "--group", "lanterns=1,1,1")),
        ):
            errors = self.compared(*light)
            for part, limit in limits.items():
                self.assertLess(errors[part], limit, part)
            # Of noise there is less in them than in what they say.
            again = self.compared(*light, paths=1024)
            for part in limits:
                self.assertLess(abs(errors[part] - again[part]), 0.2 * errors[part] + 0.3, part)
            # The three are pictures of one scene.
            for part in (1, 2):
                self.assertLess(abs(self.mean(part) - self.mean(0)), 8)

    def test_a_part_beyond_the_files_has_no_sky_of_its_own(self):
        few = tempfile.mkdtemp(dir=self.root)
        shutil.copy(os.path.join(self.sectors, "sector_1_0.drtv"), few)
        run = self.render(
            *SOUTH,
            "--size",
            "48x27",
            "--time",
            "10:00",
            "--show",
            "sun_bounce",
            "--compare",
            "--paths",
            "64",
            sectors=few,
        )
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = [line.split() for line in run.stdout.splitlines()]
        bias = {words[0]: float(words[-2]) for words in rows if words[0] in ("storage", "interpolation")}
        self.assertLess(abs(bias["storage"]), 60, run.stdout)


class BadInput(Render):
    def test_wrong_usage(self):
        out = ("--out", self.path("x.png"))
        for sentence, arguments in {
            "--out FILE.png says where": (),
            "a picture is written as .png, and not as .jpg": ("--out", self.path("x.jpg")),
            "--size takes WIDTHxHEIGHT": (*out, "--size", "0x90"),
            'not "1000000x1000000"': (*out, "--size", "1000000x1000000"),
            'not "16000x16000"': (*out, "--size", "16000x16000"),
            'not "big"': (*out, "--size", "big"),
            "--camera takes x,y,z": (*out, "--camera", "1,2", "--look", "0,0,0"),
            "--look is the camera's own place": (*out, "--camera", "1,2,3", "--look", "1,2,3"),
            "--look": (*out, "--camera", "1,2,3"),
            "--exposure takes noon, auto, or stops": (*out, "--exposure", "bright"),
            "takes one of all, ambient": (*out, "--show", "everything"),
            "--time takes a time of day such as 14:00": (*out, "--time", "25:00"),
            'not "7h"': (*out, "--times", "06:00,7h"),
            "--region takes X0,Y0,X1,Y1": (*out, "--top", "--region", "5,5,1,1"),
            'at least 1 m a side, not "5,5,5.5,9"': (*out, "--top", "--region", "5,5,5.5,9"),
            'not "0,0,1e9,5"': (*out, "--top", "--region", "0,0,1e9,5"),
            "is the camera's own place": (*out, "--camera", "0,0,0", "--look", "1e-30,0,0"),
            '--fov: takes a number from 1 to 170, not "nan"': (*out, *SOUTH, "--fov", "nan"),
            "--compare goes with light, all or a part of it, not with --show leaks": (
                *SOUTH,
                "--compare",
                "--show",
                "leaks",
            ),
            "2 x 2 pictures of 8000x8000 would have": (
                *out,
                *SOUTH,
                "--size",
                "8000x8000",
                "--times",
                "1:00,2:00,3:00",
            ),
            "--show clipped goes with --by volume": (*out, *SOUTH, "--show", "clipped", "--by", "nearest"),
            "--encoding goes with --by volume": (*out, "--top", "--encoding", "rgba8"),
            "--pick takes x,y of a pixel, up to 159,89": (*SOUTH, *SMALL, "--pick", "160,3"),
            "--fov": (*out, *SOUTH, "--fov", "180"),
            "--gradients goes with --time": (*out, "--gradients", "day.json", "--sky", "1,1,1"),
            "--paths": (*out, "--paths", "32"),
        }.items():
            with self.subTest(sentence):
                self.refused(USAGE, sentence, *arguments)

    def test_what_cannot_be_read_or_written(self):
        out = ("--out", self.path("x.png"))
        self.refused(UNREADABLE, "the map /nowhere.glb does not exist", *out, map="/nowhere.glb")
        self.refused(UNREADABLE, "holds no .glb or .gltf file", *out, map=self.sectors)
        self.refused(UNREADABLE, "/nowhere", *out, sectors="/nowhere")
        self.refused(UNREADABLE, "/nowhere/x.png", *SOUTH, *SMALL, "--out", "/nowhere/x.png")
        self.refused(UNREADABLE, "is a folder", *SOUTH, *SMALL, "--out", self.root)
        other = os.path.join(tempfile.mkdtemp(dir=self.root), "map.png")
        shutil.copy(self.map, other)
        self.refused(UNREADABLE, "is there and no PNG file", *SOUTH, *SMALL, "--out", other)
        self.refused(UNREADABLE, "day.json", *out, "--time", "12:00", "--gradients", "/nowhere/day.json")

    def test_what_is_invalid(self):
        inputs = tempfile.mkdtemp(dir=self.root)
        broken = os.path.join(inputs, "broken.glb")
        with open(broken, "wb") as file:
            file.write(b"glTF and nothing more")
        out = ("--out", self.path("x.png"))
        self.refused(INVALID, "broken.glb", *out, map=broken)
        damaged = os.path.join(inputs, "sectors")
        shutil.copytree(self.sectors, damaged)
        with open(os.path.join(damaged, "sector_1_0.drtv"), "r+b") as file:
            file.seek(300)
            file.write(b"\xff\xff")
        self.refused(INVALID, "sector_1_0.drtv", *out, *SOUTH, sectors=damaged)

    def test_cameras_where_there_is_nothing_to_see(self):
        out = ("--out", self.path("x.png"), *SMALL)
        self.refused(INVALID, "stands inside of", *out, "--camera", "11.5,30,2", "--look", "30,30,2")
        self.refused(INVALID, "stands under the ground", *out, "--camera", "30,30,-3", "--look", "30,40,-3")
        self.refused(INVALID, "has no sector within", *out, "--camera", "90000,0,2", "--look", "0,0,2")

    def test_no_ground_in_sight_is_a_picture_of_the_sky(self):
        out = self.path("sky.png")
        run = self.render(*SMALL, "--camera", "26,2,3", "--look", "26,2,40", "--exposure", "-3", "--out", out)
        self.assertEqual(
            (run.returncode, run.stderr), (0, "bakerd: warning: nothing of the map is in sight\n")
        )
        self.assertGreater(min(png_file.read(out).pixel(5, 5)), 40)

    def test_light_that_nothing_takes_is_warned_of(self):
        run = self.render(*SOUTH, *SMALL, "--group", "hut=1,1,1", "--out", self.path("x.png"))
        self.assertEqual(run.returncode, 0)
        self.assertIn('warning: none of the sectors in sight has a light group "hut"', run.stderr)

    def test_a_full_disk_behind_standard_output(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            command = [BAKERD, "render", self.sectors, "--map", self.map, *SOUTH, *SMALL, "--pick", "80,80"]
            run = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(run.returncode, UNREADABLE)
        self.assertIn("cannot write to standard output", run.stderr)

    def test_files_of_another_map(self):
        other = os.path.join(tempfile.mkdtemp(dir=self.root), "other.gltf")
        self.write_plate(other, 1500)
        self.refused(INVALID, "they are of another map", "--out", self.path("x.png"), "--top", map=other)
        self.write_plate(other, 30, z=40)
        self.refused(
            INVALID,
            "stand over no ground of the map: they are of another",
            "--out",
            self.path("x.png"),
            "--top",
            map=other,
        )
        # A part of the map may be all that one wants to see.
        self.write_plate(other, 30, z=-0.4)
        run = self.render("--out", self.path("x.png"), "--top", *SMALL, map=other)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("warning: ", run.stderr)
        self.assertIn("stand over no ground of the map: is it the one", run.stderr)

    def write_plate(self, path, x, z=0):
        corners = [(x, z, 0), (x + 50, z, 0), (x + 50, z, -50), (x, z, -50)]
        data = b"".join(struct.pack("<3f", *corners[n]) for n in (0, 1, 2, 0, 2, 3))
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        low, high = [list(f(c[k] for c in corners) for k in range(3)) for f in (min, max)]
        document = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6, "min": low, "max": high}
            ],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "buffers": [{"byteLength": len(data), "uri": uri}],
        }
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)

    def test_preview_wants_a_picture_from_above(self):
        self.drawn(*SOUTH, *SMALL)
        run = program(
            DRTV, "preview", self.sectors, "--under", self.path("picture.png"), "--out", self.path("p.png")
        )
        self.assertEqual(run.returncode, INVALID)
        self.assertIn("does not say which part of the world it shows", run.stderr)
        run = program(DRTV, "preview", self.sectors, "--under", self.map, "--out", self.path("p.png"))
        self.assertEqual(run.returncode, INVALID)
        self.assertIn("it is no PNG file", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
