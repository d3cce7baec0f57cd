"""The pictures of `drtv preview`. Usage: preview_test.py DRTV GOLDEN_FOLDER"""
import os
import struct
import sys
import unittest

import png_file
from tool_case import GOLDEN, GOLDEN_1_1, GOLDEN_1_3, UNREADABLE, Tool, golden, seal


class Preview(Tool):
    def read_png(self, path):
        picture = png_file.read(path)
        self.assertEqual(picture.chunks, ["IHDR", "IDAT", "IEND"])
        return picture.width, picture.height, picture.rows

    def test_folder_becomes_a_picture(self):
        self.write("sectors/one.drtv", golden())
        for quantity in ("relit", "sky"):
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
            self.assertIn("128 x 128 pixels, 1 sector, 2 probes", stdout)
            width, height, rows = self.read_png(out)
            self.assertEqual((width, height), (128, 128))
            self.assertGreater(len(set(b"".join(rows))), 8)
        self.assertEqual(sorted(os.listdir(self.folder)), ["relit.png", "sectors", "sky.png"])

    def middle_pixel(self, data, x_m, y_m, quantity):
        """The pixel at (x_m, y_m) in the golden sector, whose north-western corner is (-64, 192)."""
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
        )
        width, _, rows = self.read_png(out)
        x, y = int((x_m + 64) * 2), int((192 - y_m) * 2)
        return tuple(rows[y][3 * x : 3 * x + 3])

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
