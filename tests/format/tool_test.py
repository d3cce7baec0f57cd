"""The drtv tool from outside: what it prints and how it exits. Usage: tool_test.py DRTV GOLDEN_FOLDER"""
import json
import os
import shutil
import stat
import struct
import subprocess
import sys
import unittest

import jsonschema
import png_file
import sector_file
from tool_case import (
    json_lines,
    DRTV,
    GOLDEN,
    GOLDEN_1_1,
    GOLDEN_1_3,
    GOLDEN_FOLDER,
    INVALID,
    UNREADABLE,
    USAGE,
    Tool,
    golden,
    rounded,
    seal,
)


FORMAT_FOLDER = os.path.join(os.path.dirname(__file__), "..", "..", "format")


class Usage(Tool):
    def test_wrong_usage_exits_1_and_says_why(self):
        for arguments, words in [
            ([], "a command is required; drtv --help says more"),
            (["fly"], 'there is no command "fly"; drtv --help says more'),
            (["vlidate"], 'there is no command "vlidate". Did you mean "validate"? drtv --help says more'),
            (
                ["preview", GOLDEN, "--ot", "a.png"],
                'preview: there is no option "--ot". Did you mean "--out"?',
            ),
            (["validate"], "validate: PATH is required; drtv validate --help says more"),
            (["validate", "--fast", GOLDEN], 'there is no option "--fast"; drtv validate --help says more'),
            (["info"], "FILE is required"),
            (["info", GOLDEN, GOLDEN], f'"{GOLDEN}" is one argument too many'),
            (["info", GOLDEN, "--json"], 'there is no option "--json"'),
            (["dump", GOLDEN], "--json is required"),
            (["dump", "--json"], "FILE is required"),
            (["dump", GOLDEN, GOLDEN, "--json"], f'"{GOLDEN}" is one argument too many'),
            (["preview", GOLDEN], "--out is required"),
            (["preview", "--out", "a.png"], "PATH is required"),
            (["preview", GOLDEN, "--out"], "--out: 1 required FILE.png missing"),
            (["preview", GOLDEN, "--out", "a.png", "--wide"], 'there is no option "--wide"'),
            (["preview", GOLDEN, GOLDEN, "--out", "a.png"], f'"{GOLDEN}" is one argument too many'),
            (["validate", GOLDEN, "--ignore"], "--ignore: 1 required CODE missing"),
            (
                ["validate", GOLDEN, "--ignore", "STRUCTURE"],
                'there is no issue "STRUCTURE"; drtv issues lists them',
            ),
            (["validate", GOLDEN, "--quick", "--neighbours"], "--quick excludes --neighbours"),
            (["validate", GOLDEN, "--ignore", "GRID_NO_PROBE,CHECKSUM"], "CHECKSUM cannot be ignored"),
            (["diff", GOLDEN, GOLDEN, "--metres-per-pixel", "1"], "--metres-per-pixel requires --png"),
            (["validate", GOLDEN, "--quick", "--full"], "excludes"),
            (
                ["validate", GOLDEN, "--max-findings", "0"],
                '--max-findings: takes a number from 1 to 1000000, not "0"',
            ),
            (["issues", "x"], '"x" is one argument too many'),
            (["diff", GOLDEN], "B is required"),
            (["diff", GOLDEN, GOLDEN, "--png"], "--png: 1 required FILE.png missing"),
            (["strip", GOLDEN], "--out is required"),
            (["strip", GOLDEN, "--out", "x", "--keep", "transfer"], '"transfer" is no optional section'),
            (["strip", GOLDEN, "--out", "x", "--keep", "none,all"], '"none" is no optional section'),
            (
                ["strip", GOLDEN, "--out", "x", "--codec", "lz4"],
                '--codec: takes one of raw, zstd, not "lz4"',
            ),
        ]:
            with self.subTest(arguments=arguments):
                self.assertEqual(self.expect(USAGE, *arguments, err=words), "")

    def test_preview_refuses_numbers_and_quantities_that_are_none(self):
        for option, values in [
            ("--metres-per-pixel", ["0", "-1", "1000", "1m", "", "nan", "inf"]),
            ("--quantity", ["", "sun", "Sky", "back hits"]),
        ]:
            for value in values:
                with self.subTest(option=option, value=value):
                    self.expect(
                        USAGE,
                        "preview",
                        GOLDEN,
                        "--out",
                        self.path("a.png"),
                        option,
                        value,
                        err=f'not "{value}"',
                    )
        self.assertEqual(os.listdir(self.folder), [])

    def test_help_and_version_go_to_stdout(self):
        for word in ("--help", "-h"):
            self.expect(0, word, out="Exit status:\n  0    done; what was checked is valid")
        self.expect(0, "strip", "--help", out="--keep SECTION,...")
        self.expect(0, "--version", out="sector format 1.3")

    def test_full_disk_behind_stdout_is_not_success(self):
        for arguments in (
            ["dump", GOLDEN, "--json"],
            ["info", GOLDEN],
            ["validate", GOLDEN],
            ["diff", GOLDEN, GOLDEN_1_1, "--json"],
        ):
            with open("/dev/full", "wb") as full:
                result = subprocess.run([DRTV, *arguments], stdout=full, stderr=subprocess.PIPE, timeout=60)
            self.assertEqual(result.returncode, UNREADABLE)
            self.assertIn(b"cannot write to standard output", result.stderr)


class Unreadable(Tool):
    def test_missing_file_exits_2(self):
        for arguments in (
            ["validate"],
            ["info"],
            ["dump", "--json"],
            ["preview", "--out", self.path("a.png")],
            ["diff", GOLDEN],
            ["strip", "--out", self.path("b.drtv")],
        ):
            with self.subTest(arguments=arguments):
                self.expect(UNREADABLE, *arguments, self.path("none.drtv"), err="none.drtv")

    def test_folder_in_place_of_a_file_exits_2(self):
        self.expect(UNREADABLE, "dump", "--json", self.folder, err="is a folder, not a file")

    def test_read_error_exits_2(self):
        # Opens, but cannot be read; a permission would not stop root.
        if not os.path.exists("/proc/self/mem"):
            self.skipTest("no /proc")
        for arguments in (["validate"], ["info"], ["dump", "--json"]):
            self.expect(UNREADABLE, *arguments, "/proc/self/mem", err="cannot read /proc/self/mem")

    def test_folder_without_sector_files_exits_2(self):
        self.write("readme.txt", b"x")
        self.expect(UNREADABLE, "validate", self.folder, err="holds no .drtv file")
        self.expect(
            UNREADABLE, "preview", self.folder, "--out", self.path("a.png"), err="holds no .drtv file"
        )


class Validate(Tool):
    def test_good_file_exits_0(self):
        self.assertEqual(self.expect(0, "validate", GOLDEN), "1 sector file checked, 0 invalid\n")

    def test_broken_file_exits_3_and_names_place_and_rule(self):
        path = self.broken()
        stdout = self.expect(INVALID, "validate", path)
        self.assertIn(f"{path}: error CHECKSUM at byte 336: transfer section (kind 4)", stdout)
        self.assertIn("1 sector file checked, 1 invalid", stdout)

    def test_empty_file_and_other_files_exit_3(self):
        for name, data, code in (
            ("empty.drtv", b"", "NOT_A_SECTOR_FILE"),
            ("zero.drtv", bytes(5000), "NOT_A_SECTOR_FILE"),
            ("text.drtv", b"hello", "NOT_A_SECTOR_FILE"),
            ("cut.drtv", golden()[:100], "TRUNCATED"),
        ):
            self.expect(INVALID, "validate", self.write(name, data), out=f"error {code} at byte")

    def test_other_major_version_is_refused_by_name(self):
        data = golden()
        data[4] = 2
        path = self.write("new.drtv", data)
        self.expect(
            INVALID,
            "validate",
            path,
            out="error UNSUPPORTED_VERSION at byte 4: format version 2.0 is not supported",
        )
        self.expect(
            INVALID,
            "info",
            path,
            err="new.drtv: format version 2.0 is not supported: this reader knows version 1",
        )

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
        self.assertEqual(
            report["files"][0],
            {"file": GOLDEN, "valid": True, "errors": 0, "warnings": 0, "truncated": False, "findings": []},
        )
        finding = report["files"][1]["findings"][0]
        self.assertEqual(
            (finding["code"], finding["severity"], finding["offset"], finding["path"]),
            ("CHECKSUM", "error", 336, ""),
        )
        self.assertIn("does not match", finding["message"])

    def test_unreadable_beside_good_exits_2_and_beside_broken_3(self):
        none = self.path("none.drtv")
        self.expect(
            UNREADABLE, "validate", none, GOLDEN, err="does not exist", out="1 sector file checked, 0 invalid"
        )
        self.expect(
            INVALID,
            "validate",
            none,
            self.broken(),
            GOLDEN,
            err="does not exist",
            out="2 sector files checked, 1 invalid",
        )

    def test_file_name_that_is_not_utf8_still_gives_json(self):
        name = os.fsencode(self.folder) + b'/\xff"\n.drtv'
        with open(name, "wb") as file:
            file.write(golden())
        report = json.loads(self.expect(0, "validate", self.folder, "--json"))
        self.assertTrue(report["files"][0]["file"].endswith('/\ufffd"\n.drtv'))


class ValidateOptions(Tool):
    def report_of(self, *arguments, exit_code):
        return json.loads(self.expect(exit_code, "validate", "--json", *arguments))

    def empty_grid(self):
        data = golden()
        data[544:4640] = b"\xff" * 4096
        return self.write("empty_grid.drtv", seal(data))

    def with_unknown_section(self):
        """A file of version 1.0 with three sections that are unknown there."""
        data = golden(GOLDEN_1_1)
        data[6] = 0
        return self.write("old.drtv", seal(data))

    def test_reports_keep_the_schema(self):
        report = self.report_of(
            GOLDEN, self.broken(), self.empty_grid(), self.with_unknown_section(), exit_code=INVALID
        )
        self.assertEqual(
            [
                (file["valid"], file["errors"], file["warnings"], file["truncated"])
                for file in report["files"]
            ],
            [(True, 0, 0, False), (False, 1, 0, False), (False, 4096, 0, True), (True, 0, 3, False)],
        )
        self.assertEqual((report["checked"], report["invalid"], report["warnings"]), (4, 2, 3))
        self.assertEqual(
            report["files"][2]["findings"][7],
            {
                "code": "GRID_NO_PROBE",
                "severity": "error",
                "group": "index",
                "offset": 551,
                "path": "grid.cells[7]",
                "value": 255,
                "message": "names no probe, the sector has 2 that no interior names",
            },
        )
        self.assertIsNone(report["files"][1]["findings"][0]["value"])

    def test_schema_refuses_what_it_should(self):
        report = self.report_of(self.broken(), exit_code=INVALID)
        for path, value in (
            (["files", 0, "findings", 0, "severity"], "fatal"),
            (["files", 0, "findings", 0, "offset"], -1),
            (["files", 0, "errors"], "1"),
            (["more"], 1),
        ):
            changed = json.loads(json.dumps(report))
            at = changed
            for key in path[:-1]:
                at = at[key]
            at[path[-1]] = value
            with self.assertRaises(jsonschema.ValidationError):
                json_lines.check("drtv", "validate", json.dumps(changed))

    def test_findings_are_capped_and_say_so(self):
        path = self.empty_grid()
        stdout = self.expect(INVALID, "validate", path, "--max-findings", "2")
        self.assertEqual(stdout.count("GRID_NO_PROBE"), 2)
        self.assertIn("4096 findings, the first 2 are shown", stdout)

    def test_quick_looks_at_the_structure_only(self):
        self.expect(0, "validate", "--quick", self.empty_grid())
        self.expect(INVALID, "validate", "--quick", self.broken())

    def test_ignored_code_does_not_count(self):
        self.expect(
            0,
            "validate",
            self.empty_grid(),
            "--ignore",
            "GRID_REFERENCE,GRID_NO_PROBE",
            "--ignore",
            "ENERGY",
            out="1 sector file checked, 0 invalid\n",
        )

    def test_warnings_fail_only_when_asked(self):
        path = self.with_unknown_section()
        self.assertIn(
            "warning UNKNOWN_SECTION at byte 4912",
            self.expect(0, "validate", path, out="0 invalid, 3 warnings\n"),
        )
        self.expect(INVALID, "validate", "--warnings-as-errors", path, out="1 invalid, 3 warnings\n")
        self.expect(0, "validate", "--warnings-as-errors", path, "--ignore", "UNKNOWN_SECTION")

    def moved(self, i, j, change=None):
        data = golden()
        struct.pack_into("<ii", data, 16, i, j)
        if change:
            change(data)
        return seal(data)

    def test_neighbours_are_looked_at_folder_by_folder(self):
        def other_key(data):
            data[272] = 99

        for i in range(3):
            self.write(f"a/sector_{i}_0.drtv", self.moved(i, 0, other_key if i == 1 else None))
        self.write("b/sector_0_0.drtv", self.moved(0, 0, other_key))
        self.write("b/sector_5_-7.drtv", self.moved(5, 7))
        self.expect(0, "validate", self.folder)
        report = self.report_of("--neighbours", self.folder, exit_code=INVALID)
        codes = {
            os.path.relpath(file["file"], self.folder): [finding["code"] for finding in file["findings"]]
            for file in report["files"]
            if file["findings"]
        }
        self.assertEqual(codes["a/sector_1_0.drtv"], ["SET_SETTINGS"])
        self.assertIn("SET_FILE_NAME", codes["b/sector_5_-7.drtv"])
        self.assertNotIn("a/sector_0_0.drtv", codes)
        self.assertIn(
            "2 folders, the borders of each by itself\n",
            self.expect(INVALID, "validate", "--neighbours", self.folder),
        )
        # Named one by one they are still one folder.
        files = [os.path.join(self.folder, "a", f"sector_{i}_0.drtv") for i in range(3)]
        self.expect(INVALID, "validate", "--neighbours", *files, out="error SET_SETTINGS")
        self.expect(0, "validate", "--neighbours", "--ignore", "SET_SETTINGS", *files)

    def test_many_files_are_reported_in_their_order(self):
        for n in range(60):
            self.write(f"{n:02}.drtv", b"no" if n % 7 == 3 else golden())
        report = self.report_of(self.folder, exit_code=INVALID)
        self.assertEqual(
            [os.path.basename(file["file"]) for file in report["files"]], [f"{n:02}.drtv" for n in range(60)]
        )
        self.assertEqual([file["valid"] for file in report["files"]], [n % 7 != 3 for n in range(60)])


class Issues(Tool):
    def test_page_is_not_stale(self):
        with open(os.path.join(FORMAT_FOLDER, "ISSUES.md"), encoding="utf-8") as file:
            self.assertEqual(self.expect(0, "issues"), file.read(), "run: drtv issues > format/ISSUES.md")


class Strip(Tool):
    GOLDEN_1_2 = os.path.join(GOLDEN_FOLDER, "format_1_2.drtv")

    def kept(self, *arguments):
        out = self.path("out.drtv")
        self.expect(0, "strip", self.GOLDEN_1_2, "--out", out, *arguments)
        self.expect(0, "validate", out)
        dumped = json.loads(self.expect(0, "dump", out, "--json"))
        probe = dumped["probes"][0]
        return dumped["format_version"], [name for name in ("convergence", "interiors") if name in dumped] + [
            name for name in ("static_irradiance", "local") if name in probe
        ]

    def test_keeps_what_is_asked(self):
        self.assertEqual(self.kept(), ("1.2", ["convergence", "interiors", "static_irradiance", "local"]))
        self.assertEqual(self.kept("--keep", "none"), ("1.0", []))
        self.assertEqual(self.kept("--keep", "local_transfer"), ("1.1", ["local"]))
        self.assertEqual(
            self.kept("--keep", "static_irradiance,interiors"), ("1.2", ["interiors", "static_irradiance"])
        )

    def test_one_kind_alone_is_the_golden_file_of_that_kind(self):
        for version, names in (
            ("1_1", ("static_irradiance", "local_transfer", "convergence")),
            ("1_3", ("light_groups", "local_transfer", "quality")),
        ):
            for name in names:
                out = self.path("out.drtv")
                whole, alone = (
                    os.path.join(GOLDEN_FOLDER, f"format_{version}{rest}.drtv") for rest in ("", "_" + name)
                )
                self.expect(0, "strip", whole, "--out", out, "--keep", name)
                self.assertEqual(golden(out), golden(alone))

    def test_quality_is_dropped_unless_it_is_asked_for(self):
        out = self.path("out.drtv")
        for arguments, kept in (([], False), (["--keep", "all"], True)):
            self.expect(0, "strip", GOLDEN_1_3, "--out", out, *arguments)
            dumped = json.loads(self.expect(0, "dump", out, "--json"))
            self.assertEqual("quality" in dumped, kept)
            self.assertEqual(dumped["light_groups"], ["lanterns", "nächtliche Fenster"])

    def test_compressed_and_back_are_the_same_bytes(self):
        packed, raw = self.path("packed.drtv"), self.path("raw.drtv")
        self.expect(0, "strip", self.GOLDEN_1_2, "--out", packed, "--codec", "zstd")
        self.assertLess(os.path.getsize(packed), os.path.getsize(self.GOLDEN_1_2) // 2)
        self.expect(0, "strip", packed, "--out", raw)
        self.assertEqual(golden(raw), golden(self.GOLDEN_1_2))

    def test_folder_keeps_its_names(self):
        self.write("in/a/one.drtv", golden())
        self.write("in/two.drtv", golden(GOLDEN_1_1))
        self.expect(
            0,
            "strip",
            self.path("in"),
            "--out",
            self.path("out"),
            "--keep",
            "none",
            out="2 sector files, 9960 bytes before, 9488 after",
        )
        self.assertEqual(golden(self.path("out/a/one.drtv")), golden())
        self.assertTrue(os.path.exists(self.path("out/two.drtv")))

    def test_broken_file_is_told_and_nothing_written(self):
        self.expect(
            INVALID, "strip", self.broken(), "--out", self.path("out.drtv"), err="its checksum does not match"
        )
        self.assertEqual(os.listdir(self.folder), ["broken.drtv"])
        self.write("in/a.drtv", golden())
        self.broken("in/z.drtv")
        self.expect(
            INVALID, "strip", self.path("in"), "--out", self.path("out"), err="z.drtv: transfer section"
        )
        self.assertFalse(os.path.exists(self.path("out")))

    def test_input_is_never_written_over(self):
        self.write("in/a.drtv", golden())
        for out in (self.path("in"), self.path("in/console"), self.path("in/../in/")):
            self.expect(USAGE, "strip", self.path("in"), "--out", out, err="write to another place")
        self.expect(
            USAGE,
            "strip",
            self.path("in/a.drtv"),
            "--out",
            self.path("in/a.drtv"),
            err="write to another place",
        )
        self.expect(
            USAGE,
            "strip",
            self.path("in/a.drtv"),
            "--out",
            self.path("in"),
            err="a.drtv is a file that is stripped",
        )
        self.assertEqual(os.listdir(self.path("in")), ["a.drtv"])
        self.assertEqual(golden(self.path("in/a.drtv")), golden())

    def test_other_files_in_the_target_are_told(self):
        self.write("in/a.drtv", golden())
        self.write("out/old.drtv", golden())
        self.expect(
            0,
            "strip",
            self.path("in"),
            "--out",
            self.path("out"),
            out="holds 1 other sector file, left as it was\n",
        )

    def test_devices_are_not_replaced_and_links_are_followed(self):
        pipe, link, target = self.path("pipe"), self.path("link.drtv"), self.path("target.drtv")
        os.mkfifo(pipe)
        self.expect(UNREADABLE, "strip", GOLDEN, "--out", pipe, err="it is not a regular file")
        self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))
        self.write("target.drtv", b"old")
        os.symlink(target, link)
        self.expect(0, "strip", GOLDEN, "--out", link)
        self.assertTrue(os.path.islink(link))
        self.assertEqual(golden(target), golden())


class Diff(Tool):
    DIFFERENT = 4

    def changed(self, change):
        data = golden(GOLDEN_1_1)
        change(data)
        return self.write("changed.drtv", seal(data))

    def test_equal_files_exit_0(self):
        self.assertEqual(
            self.expect(0, "diff", GOLDEN, GOLDEN),
            "1 sector compared, 0 differ; 0 only in the first, 0 only in the second\n",
        )
        self.expect(0, "diff", GOLDEN, os.path.join(GOLDEN_FOLDER, "format_1_0_zstd.drtv"))

    def test_changed_number_is_named_and_measured(self):
        def change(data):
            # Probe 1's T_g[2][0], by 1000 codes of scale 0.5; transfer begins at 464 there.
            self.assertEqual(struct.unpack_from("<h", data, 464 + 96 + 32 + 16)[0], 1966)
            struct.pack_into("<h", data, 464 + 96 + 32 + 16, 2966)

        path = self.changed(change)
        stdout = self.expect(self.DIFFERENT, "diff", GOLDEN_1_1, path)
        self.assertIn("sector (-1, 2): 1 of 3 probes changed, 0 added, 0 removed; 0 grid cells\n", stdout)
        report = json.loads(self.expect(self.DIFFERENT, "diff", GOLDEN_1_1, path, "--json"))
        transfer = report["sectors"][0]["changes"]["transfer"]
        self.assertAlmostEqual(transfer["largest"], 1000 / 32767 / 2, places=6)
        self.assertAlmostEqual(transfer["rms"], 1000 / 32767 / 2 / (3 * 48) ** 0.5, places=6)
        self.assertEqual(transfer["at"], "probe[1].transfer.g[2][0]")
        # A sky of radiance 1 has 3.5449 of Y0.
        self.assertAlmostEqual(report["changes"]["relit"]["largest"], 3.5449 * 1000 / 32767 / 2, places=4)
        self.assertEqual((report["compared"], report["different"]), (1, 1))

    def test_moved_probe_is_one_removed_and_one_added(self):
        def change(data):
            struct.pack_into("<H", data, 400, 50000)  # x of probe 0

        stdout = self.expect(self.DIFFERENT, "diff", GOLDEN_1_1, self.changed(change))
        self.assertIn(
            "1 of 3 probes changed, 1 added, 1 removed; 2048 grid cells; 2 local pairs added, 2 removed",
            stdout,
        )
        self.assertRegex(stdout, r"probe\[1\].local from (the first's )?probe 0 of \(-1, 2\)")

    def test_sectors_of_one_side_only_are_named(self):
        self.write("a/one.drtv", golden())
        other = golden()
        struct.pack_into("<ii", other, 16, 7, 8)
        self.write("b/two.drtv", seal(other))
        stdout = self.expect(self.DIFFERENT, "diff", self.path("a"), self.path("b"))
        self.assertIn(
            "sector (-1, 2): only in the first\nsector (7, 8): only in the second\n0 sectors compared", stdout
        )

    def test_settings_and_sections_that_differ_are_told(self):
        self.expect(self.DIFFERENT, "diff", GOLDEN, self.changed(lambda data: None), out="1 added, 0 removed")

        def change(data):
            data[370] ^= 1

        self.expect(self.DIFFERENT, "diff", GOLDEN_1_1, self.changed(change), out="; settings differ\n")

    def test_picture_is_drawn(self):
        def change(data):
            struct.pack_into("<H", data, 400, 50000)

        out = self.path("diff.png")
        self.expect(
            self.DIFFERENT,
            "diff",
            GOLDEN_1_1,
            self.changed(change),
            "--png",
            out,
            "--metres-per-pixel",
            "0.5",
        )
        picture = png_file.read(out)
        self.assertEqual((picture.width, picture.height), (512, 512))
        x0, y0, x1, y1 = picture.world()
        self.assertEqual((x1 - x0, y1 - y0), (256, 256))

    def test_same_sector_twice_on_one_side_is_refused(self):
        self.write("a/one.drtv", golden())
        self.write("a/two.drtv", golden())
        self.expect(INVALID, "diff", self.path("a"), GOLDEN, err="hold the same sector (-1, 2)")


class Show(Tool):
    def golden_files(self):
        return sorted(
            os.path.join(GOLDEN_FOLDER, name) for name in os.listdir(GOLDEN_FOLDER) if name.endswith(".drtv")
        )

    def test_dump_equals_what_the_page_says_the_bytes_mean(self):
        for path in self.golden_files():
            with self.subTest(path=path):
                dumped = json.loads(self.expect(0, "dump", path, "--json"))
                self.assertEqual(rounded(dumped), rounded(sector_file.read(bytes(golden(path)))))

    def test_dump_has_the_optional_keys_only_where_the_sections_are(self):
        keys = {}
        for path in (GOLDEN, GOLDEN_1_1):
            dumped = json.loads(self.expect(0, "dump", path, "--json"))
            keys[path] = [key in dumped for key in ("convergence",)] + [
                key in dumped["probes"][0] for key in ("static_irradiance", "local")
            ]
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

    def test_dump_of_the_golden_files_is_frozen(self):
        for path in self.golden_files():
            with open(path.replace(".drtv", ".json"), encoding="utf-8") as file:
                self.assertEqual(self.expect(0, "dump", path, "--json"), file.read())

    def test_dump_is_exact_far_from_the_origin(self):
        # Sector (16384, -16384) and a z origin of 2^30 - 1 units: a float would round the positions.
        data = golden()
        struct.pack_into("<iii", data, 16, 16384, -16384, 2**30 - 1)
        struct.pack_into("<H", data, 304, 16385)
        dumped = json.loads(self.expect(0, "dump", self.write("far.drtv", seal(data)), "--json"))
        self.assertEqual(
            dumped["probes"][0]["position"], sector_file.read(bytes(data))["probes"][0]["position"]
        )

    def test_version_shown_is_the_files_own(self):
        data = golden()
        data[6] = 3
        path = self.write("minor.drtv", seal(data))
        self.expect(0, "info", path, out="format 1.3\n")
        self.assertEqual(json.loads(self.expect(0, "dump", path, "--json"))["format_version"], "1.3")

    def test_info_names_sector_probes_and_sections(self):
        stdout = self.expect(0, "info", GOLDEN)
        for words in (
            "(-1, 2): x -64 to 0 m, y 128 to 192 m",
            "4680 bytes, format 1.0",
            "2 (1 ground, 0 vegetation, 1 manual)",
            "10.00 to 12.00 m",
            "rays 2048, bounces 3, reach 512 m, min_distance 6 m",
            "000102030405",
            "9 candidates",
            "7.5 m",
            "12288",
            "statistics",
            "4112 bytes",
        ):
            self.assertIn(words, stdout)

    def test_info_of_a_folder_sums_it_up(self):
        folder = self.path("sectors")
        os.mkdir(folder)
        for name in (GOLDEN, GOLDEN_1_3):
            shutil.copy(name, folder)
        stdout = self.expect(0, "info", folder)
        for words in (
            "files           2, 0.0 MB, format 1.0 and 1.3\n",
            "probes          ",
            "light groups    lanterns",
            "settings        rays",
        ):
            self.assertIn(words, stdout)
        os.mkdir(self.path("empty"))
        self.expect(UNREADABLE, "info", self.path("empty"), err="holds no .drtv file")

    def test_info_has_a_line_for_each_optional_section(self):
        lines = {
            "static light    up to 32 (E/pi)\n",
            "local lights    5 pairs of probe and source, 3 sources, of which 1 in neighbours\n",
            "convergence     error 0.02 asked, 0.0125 median, 0.01875 at 95 %, 0.03125 at most; 256 to 4096 paths per probe\n",
        }
        stdout, before = self.expect(0, "info", GOLDEN_1_1), self.expect(0, "info", GOLDEN)
        for line in lines:
            self.assertIn(line, stdout)
            self.assertNotIn(line.split("  ")[0], before)

    def test_info_tells_of_light_groups_and_quality(self):
        stdout = self.expect(0, "info", GOLDEN_1_3)
        for line in (
            "light group     lanterns, up to 6.75561e+15 (E/pi)\n",
            "quality         1 dark, 1 moved out of a solid, 1 short of the error asked; "
            "100 cells in solids or under ground, 7 that see no probe of theirs\n",
            "  transfer           0.00781, 0.5, 0.5, of 3 probes\n",
            "  group 'lanterns'   1.5, 1.5, 1.5, of 2 probes\n",
            "  group 'nächtliche Fenster' 0.0625, 0.0625, 0.0625, of 2 probes\n",
        ):
            self.assertIn(line, stdout)

    def test_broken_file_exits_3_with_the_reason_on_stderr(self):
        path = self.broken()
        for arguments in (["info"], ["dump", "--json"], ["preview", "--out", self.path("a.png")]):
            self.assertEqual(
                self.expect(INVALID, *arguments, path, err="its checksum does not match its bytes"), ""
            )
        self.assertEqual(os.listdir(self.folder), ["broken.drtv"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
