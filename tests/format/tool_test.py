"""The drtv tool from outside: what it prints and how it exits. Usage: tool_test.py DRTV GOLDEN_FOLDER"""
import json
import os
import struct
import subprocess
import sys
import unittest

import sector_file
from tool_case import DRTV, GOLDEN, GOLDEN_1_1, GOLDEN_FOLDER, INVALID, UNREADABLE, USAGE, Tool, golden, rounded, seal


class Usage(Tool):
    def test_wrong_usage_exits_1_and_says_why(self):
        for arguments, words in [
                ([], "usage: drtv"), (["fly"], 'unknown command "fly"'), (["validate"], "at least one file or folder"),
                (["validate", "--fast", GOLDEN], 'unknown option "--fast"'), (["info"], "exactly one file"), (["info", GOLDEN, GOLDEN], "exactly one file"),
                (["info", "--json"], "exactly one file"), (["dump", GOLDEN], "usage is: drtv dump FILE --json"), (["dump", "--json"], "usage is"),
                (["dump", GOLDEN, GOLDEN, "--json"], "usage is"), (["preview", GOLDEN], "usage is: drtv preview"), (["preview", "--out", "a.png"], "usage is"),
                (["preview", GOLDEN, "--out"], "--out needs a value"), (["preview", GOLDEN, "--wide"], 'unknown option "--wide"'),
                (["preview", GOLDEN, GOLDEN, "--out", "a.png"], "one too many")]:
            with self.subTest(arguments=arguments):
                self.assertEqual(self.expect(USAGE, *arguments, err=words), "")

    def test_preview_refuses_numbers_and_quantities_that_are_none(self):
        for option, values in [("--metres-per-pixel", ["0", "-1", "1000", "1m", "", "nan", "inf"]), ("--quantity", ["", "sun", "Sky", "back hits"])]:
            for value in values:
                with self.subTest(option=option, value=value):
                    self.expect(USAGE, "preview", GOLDEN, "--out", self.path("a.png"), option, value, err=f'not "{value}"')
        self.assertEqual(os.listdir(self.folder), [])

    def test_help_and_version_go_to_stdout(self):
        for word in ("--help", "-h", "help"):
            self.expect(0, word, out="exit status: 0 valid, 1 wrong usage")
        self.expect(0, "--version", out="sector format 1.1")

    def test_full_disk_behind_stdout_is_not_success(self):
        for arguments in (["dump", GOLDEN, "--json"], ["info", GOLDEN], ["validate", GOLDEN]):
            with open("/dev/full", "wb") as full:
                result = subprocess.run([DRTV, *arguments], stdout=full, stderr=subprocess.PIPE, timeout=60)
            self.assertEqual(result.returncode, UNREADABLE)
            self.assertIn(b"cannot write to standard output", result.stderr)


class Unreadable(Tool):
    def test_missing_file_exits_2(self):
        for arguments in (["validate"], ["info"], ["dump", "--json"], ["preview", "--out", self.path("a.png")]):
            with self.subTest(arguments=arguments):
                self.expect(UNREADABLE, *arguments, self.path("none.drtv"), err="none.drtv")

    def test_folder_in_place_of_a_file_exits_2(self):
        for arguments in (["info"], ["dump", "--json"]):
            self.expect(UNREADABLE, *arguments, self.folder, err="is a folder, not a file")

    def test_read_error_exits_2(self):
        # Opens, but cannot be read; a permission would not stop root.
        if not os.path.exists("/proc/self/mem"):
            self.skipTest("no /proc")
        for arguments in (["validate"], ["info"], ["dump", "--json"]):
            self.expect(UNREADABLE, *arguments, "/proc/self/mem", err="cannot read /proc/self/mem")

    def test_folder_without_sector_files_exits_2(self):
        self.write("readme.txt", b"x")
        self.expect(UNREADABLE, "validate", self.folder, err="holds no .drtv file")
        self.expect(UNREADABLE, "preview", self.folder, "--out", self.path("a.png"), err="holds no .drtv file")


class Validate(Tool):
    def test_good_file_exits_0(self):
        self.assertEqual(self.expect(0, "validate", GOLDEN), "1 sector file checked, 0 invalid\n")

    def test_broken_file_exits_3_and_names_place_and_rule(self):
        path = self.broken()
        stdout = self.expect(INVALID, "validate", path)
        self.assertIn(f"{path}: error CHECKSUM at byte 336: transfer section (kind 4)", stdout)
        self.assertIn("1 sector file checked, 1 invalid", stdout)

    def test_empty_file_and_other_files_exit_3(self):
        for name, data in (("empty.drtv", b""), ("zero.drtv", bytes(5000)), ("text.drtv", b"hello"), ("cut.drtv", golden()[:100])):
            self.expect(INVALID, "validate", self.write(name, data), out="error STRUCTURE at byte")

    def test_other_major_version_is_refused_by_name(self):
        data = golden()
        data[4] = 2
        path = self.write("new.drtv", data)
        self.expect(INVALID, "validate", path, out="error UNSUPPORTED_VERSION at byte 4: format version 2.0 is not supported")
        self.expect(INVALID, "info", path, err="new.drtv: format version 2.0 is not supported: this reader knows version 1")

    def test_folder_is_searched_below_and_every_file_reported(self):
        self.write("b/good.drtv", golden())
        self.write("a/c/good too.drtv", golden())
        self.broken("a/broken.drtv")
        self.write("a/ignored.txt", b"no sector")
        os.mkdir(self.path("folder.drtv"))
        stdout = self.expect(INVALID, "validate", self.folder)
        self.assertIn("3 sector files checked, 1 invalid", stdout)
        report = json.loads(self.expect(INVALID, "validate", "--json", self.folder))
        names = [os.path.relpath(file["file"], self.folder) for file in report["files"]]
        self.assertEqual(names, ["a/broken.drtv", "a/c/good too.drtv", "b/good.drtv"])
        self.assertEqual([file["valid"] for file in report["files"]], [False, True, True])

    def test_json_holds_findings_and_counts(self):
        broken = self.broken()
        report = json.loads(self.expect(INVALID, "validate", GOLDEN, broken, "--json"))
        self.assertEqual((report["checked"], report["invalid"]), (2, 1))
        self.assertEqual(report["files"][0], {"file": GOLDEN, "valid": True, "findings": []})
        finding = report["files"][1]["findings"][0]
        self.assertEqual((finding["code"], finding["severity"], finding["offset"], finding["path"]), ("CHECKSUM", "error", 336, ""))
        self.assertIn("does not match", finding["message"])

    def test_unreadable_beside_good_exits_2_and_beside_broken_3(self):
        none = self.path("none.drtv")
        self.expect(UNREADABLE, "validate", none, GOLDEN, err="does not exist", out="1 sector file checked, 0 invalid")
        self.expect(INVALID, "validate", none, self.broken(), GOLDEN, err="does not exist", out="2 sector files checked, 1 invalid")

    def test_file_name_that_is_not_utf8_still_gives_json(self):
        name = os.fsencode(self.folder) + b"/\xff\"\n.drtv"
        with open(name, "wb") as file:
            file.write(golden())
        report = json.loads(self.expect(0, "validate", self.folder, "--json"))
        self.assertTrue(report["files"][0]["file"].endswith('/\ufffd"\n.drtv'))


class Show(Tool):
    def test_dump_equals_what_the_page_says_the_bytes_mean(self):
        for path in (GOLDEN, GOLDEN_1_1):
            with self.subTest(path=path):
                dumped = json.loads(self.expect(0, "dump", path, "--json"))
                self.assertEqual(rounded(dumped), rounded(sector_file.read(bytes(golden(path)))))

    def test_dump_has_the_optional_keys_only_where_the_sections_are(self):
        keys = {}
        for path in (GOLDEN, GOLDEN_1_1):
            dumped = json.loads(self.expect(0, "dump", path, "--json"))
            keys[path] = [key in dumped for key in ("convergence",)] + [key in dumped["probes"][0] for key in ("static_irradiance", "local")]
        self.assertEqual(keys, {GOLDEN: [False] * 3, GOLDEN_1_1: [True] * 3})

    def test_dump_of_exponents_beyond_their_limits_is_still_finite(self):
        data = golden(GOLDEN_1_1)
        data[4992 + 23] = data[4992 + 36] = 127  # of source 1 and of receiver 0, which are a pair
        struct.pack_into("<3b", data, 4912 + 72, 127, -128, 127)
        path = self.write("steep.drtv", seal(data))
        self.expect(INVALID, "validate", path, out="error STATIC_EXPONENT")
        self.assertNotRegex(self.expect(0, "dump", path, "--json"), "null|inf|nan")

    def test_dump_of_a_packed_file_is_the_same(self):
        packed = os.path.join(GOLDEN_FOLDER, "format_1_0_zstd.drtv")
        self.assertEqual(self.expect(0, "dump", "--json", packed), self.expect(0, "dump", GOLDEN, "--json"))

    def test_dump_of_the_golden_file_is_frozen(self):
        for path in (GOLDEN, GOLDEN_1_1):
            with open(path.replace(".drtv", ".json"), encoding="utf-8") as file:
                self.assertEqual(self.expect(0, "dump", path, "--json"), file.read())

    def test_dump_is_exact_far_from_the_origin(self):
        # Sector (16384, -16384) and a z origin of 2^30 - 1 units: a float would round the positions.
        data = golden()
        struct.pack_into("<iii", data, 16, 16384, -16384, 2**30 - 1)
        struct.pack_into("<H", data, 304, 16385)
        dumped = json.loads(self.expect(0, "dump", self.write("far.drtv", seal(data)), "--json"))
        self.assertEqual(dumped["probes"][0]["position"], sector_file.read(bytes(data))["probes"][0]["position"])

    def test_version_shown_is_the_files_own(self):
        data = golden()
        data[6] = 3
        path = self.write("minor.drtv", seal(data))
        self.expect(0, "info", path, out="format 1.3\n")
        self.assertEqual(json.loads(self.expect(0, "dump", path, "--json"))["format_version"], "1.3")

    def test_info_names_sector_probes_and_sections(self):
        stdout = self.expect(0, "info", GOLDEN)
        for words in ("(-1, 2): x -64 to 0 m, y 128 to 192 m", "4680 bytes, format 1.0", "2 (1 ground, 0 vegetation, 1 manual)", "10.00 to 12.00 m",
                      "rays 2048, bounces 3, reach 512 m, min_distance 6 m", "000102030405", "9 candidates", "7.5 m", "12288", "statistics", "4112 bytes"):
            self.assertIn(words, stdout)

    def test_info_has_a_line_for_each_optional_section(self):
        lines = {"static light    up to 32 (E/pi)\n", "local lights    5 pairs of probe and source, 3 sources, of which 1 in neighbours\n",
                 "convergence     error 0.02 asked, 0.0125 median, 0.01875 at 95 %, 0.03125 at most; 256 to 4096 paths a probe\n"}
        stdout, before = self.expect(0, "info", GOLDEN_1_1), self.expect(0, "info", GOLDEN)
        for line in lines:
            self.assertIn(line, stdout)
            self.assertNotIn(line.split("  ")[0], before)

    def test_broken_file_exits_3_with_the_reason_on_stderr(self):
        path = self.broken()
        for arguments in (["info"], ["dump", "--json"], ["preview", "--out", self.path("a.png")]):
            self.assertEqual(self.expect(INVALID, *arguments, path, err="its checksum does not match its bytes"), "")
        self.assertEqual(os.listdir(self.folder), ["broken.drtv"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
