"""The pictures of `drtv preview`. Usage: preview_test.py DRTV GOLDEN_FOLDER"""
import os
import struct
import sys
import unittest

import png_file
from tool_case import GOLDEN, GOLDEN_1_1, GOLDEN_1_3, UNREADABLE, USAGE, Tool, golden, seal


class Preview(Tool):
    def read_png(self, path):
        picture = png_file.read(path)
        self.assertEqual(picture.chunks, ["IHDR", "tEXt", "tEXt", "IDAT", "IEND"])
        return picture

    def test_folder_becomes_a_picture(self):
        self.write("sectors/one.drtv", golden())
        for quantity in ("relit", "sky", "static", "dark", "kind", "errors", "back_hits"):
            out = self.path(quantity + ".png")
            stdout = self.expect(
                0,
                "preview",
                self.path("sectors"),
                "--out",
                out,
                "--metres-per-pixel",
                "0.5",
                "--quantity",
                quantity,
            )
            self.assertIn("512 x 512 pixels, 1 sector, 2 probes", stdout)
            picture = self.read_png(out)
            self.assertEqual((picture.width, picture.height), (512, 512))
            x0, y0, x1, y1 = picture.world()
            self.assertEqual((x1 - x0, y1 - y0), (256, 256))
            dots = {picture.at(-48 + x, 160 + y) for x in (-1, 0, 1) for y in (-1, 0, 1)}
            self.assertEqual(len(dots), 1, quantity + ": a probe stands there")
            self.assertNotEqual(dots, {picture.at(-20, 180)}, quantity)

    def test_a_scale_that_is_too_fine_is_bounded_and_said(self):
        out = self.path("a.png")
        self.expect(
            0,
            "preview",
            GOLDEN,
            "--out",
            out,
            "--metres-per-pixel",
            "0.0001",
            err="the map is drawn at 0.008929 m a pixel, for the limit is 8,192 with the frame",
        )
        with open(out, "rb") as file:
            width, height = struct.unpack(">II", file.read(24)[16:24])
        self.assertTrue(7168 < max(width, height) <= 8192)

    def test_other_endings_and_a_time_with_another_quantity_are_wrong_usage(self):
        for name in ("a.jpg", "a", "a.svg"):
            self.expect(
                USAGE, "preview", GOLDEN, "--out", self.path(name), err="a picture is written as .png"
            )
        time = ("preview", GOLDEN, "--out", self.path("a.png"), "--time", "12:00")
        self.expect(USAGE, *time, "--quantity", "sky", err="--time goes with --quantity relit")
        self.expect(USAGE, *time[:-1], "25:00", err="25:00")
        self.assertEqual(os.listdir(self.folder), [])

    def test_the_time_changes_what_is_relit(self):
        day = [self.middle_pixel(golden(), -48, 160, "relit", "--time", time) for time in ("06:30", "12:00")]
        self.assertNotEqual(*day)

    def test_the_legend_stands_below_the_map(self):
        """Its colours are those of the probes: of kinds, hand-placed ones are blue."""
        out = self.path("kind.png")
        self.expect(0, "preview", GOLDEN, "--out", out, "--quantity", "kind")
        picture = self.read_png(out)
        below = picture.rows[1500:]
        legend = {row[3 * x : 3 * x + 3] for row in below for x in range(picture.width)}
        for colour in ((255, 255, 0), (0, 255, 0), (63, 137, 255), (255, 160, 0)):
            self.assertIn(bytes(colour), legend)

    def middle_pixel(self, data, x_m, y_m, quantity, *more):
        """The pixel at a place in the golden sector."""
        out = self.path("pixel.png")
        self.expect(
            0,
            "preview",
            self.write("pixel.drtv", data),
            "--out",
            out,
            "--metres-per-pixel",
            "0.5",
            "--quantity",
            quantity,
            *more,
        )
        return self.read_png(out).at(x_m, y_m)

    # In the golden file of 1.3: the quality of probe 0, and its errors of the two light groups.
    QUALITY, GROUP_ERRORS = 7216, (7288, 7300)

    def with_quality(self, errors=(0, 0, 0), group_errors=(0, 0), paths=1, back_hits=0):
        data = golden(GOLDEN_1_3)
        struct.pack_into("<fffII", data, self.QUALITY, *errors, paths, back_hits)
        for offset, error in zip(self.GROUP_ERRORS, group_errors):
            struct.pack_into("<f", data, offset, error)
        return seal(data)

    def test_back_hits_colour_a_probe_green_to_red_and_grey_where_unknown(self):
        for back_hits, colour in (
            (0, (0, 255, 0)),
            (25, (255, 255, 0)),
            (50, (255, 0, 0)),
            (1000, (255, 0, 0)),
        ):
            data = self.with_quality(paths=1000, back_hits=back_hits)
            self.assertEqual(self.middle_pixel(data, -48, 160, "back_hits"), colour, back_hits)
        red, green, blue = self.middle_pixel(golden(), -48, 160, "back_hits")
        self.assertTrue(red == green == blue < 255)

    def test_the_largest_error_colours_a_probe_green_to_red_and_grey_where_unknown(self):
        for errors, group_errors, colour in (
            ((0, 0, 0), (0, 0), (0, 255, 0)),
            ((0.01, 0.05, 0), (0, 0), (255, 255, 0)),
            ((0, 0, 0.05), (0.01, 0), (255, 255, 0)),
            ((0.3, 0, 0), (0, 0), (255, 0, 0)),
            ((0, 0, 0), (0, 0.3), (255, 0, 0)),
        ):
            data = self.with_quality(errors, group_errors)
            self.assertEqual(self.middle_pixel(data, -48, 160, "errors"), colour, errors)
        red, green, blue = self.middle_pixel(golden(), -48, 160, "errors")
        self.assertTrue(red == green == blue < 255)

    def test_dark_probes_are_red_lit_ones_green(self):
        for flags, colour in ((0b101, (0, 255, 0)), (0b010, (255, 0, 0))):
            data = golden(GOLDEN_1_3)
            data[self.QUALITY + 20] = flags
            self.assertEqual(self.middle_pixel(seal(data), -48, 160, "dark"), colour)
        self.assertEqual(len(set(self.middle_pixel(golden(), -48, 160, "dark"))), 1)

    def test_relit_shows_static_irradiance(self):
        # The map's own light at probe 0 is red.
        with_light, without = self.middle_pixel(golden(GOLDEN_1_1), -48, 160, "relit"), self.middle_pixel(
            golden(), -48, 160, "relit"
        )
        self.assertGreater(with_light[0], without[0])
        self.assertEqual(with_light[2], without[2])

    def test_place_that_cannot_be_written_exits_2_and_leaves_nothing(self):
        out = self.path("no such folder/a.png")
        self.expect(
            UNREADABLE, "preview", GOLDEN, "--out", out, "--metres-per-pixel", "1", err="cannot write " + out
        )
        os.mkdir(self.path("folder.png"))
        self.expect(
            UNREADABLE,
            "preview",
            GOLDEN,
            "--out",
            self.path("folder.png"),
            "--metres-per-pixel",
            "1",
            err="cannot write",
        )
        self.assertEqual(os.listdir(self.folder), ["folder.png"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
