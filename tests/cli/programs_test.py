"""What the three programs have in common: help, version, exit codes, and what they say. Usage: SCRIPT BIN_FOLDER"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import json_lines

BIN = sys.argv[1]
COMMANDS = {
    "drtv": ["validate", "issues", "info", "dump", "preview", "strip", "tiles", "diff", "relight"],
    "bake": [
        "submit",
        "plan",
        "list",
        "status",
        "watch",
        "wait",
        "cancel",
        "raise",
        "hold",
        "release",
        "report",
        "retry",
        "pull",
        "logs",
        "cache",
    ],
    "bakerd": ["serve", "worker", "task", "render", "doctor"],
}
# Nobody listens there.
NOWHERE = "127.0.0.1:1"
USAGE, UNREADABLE, SERVER = 1, 2, 7


def run(program, *arguments):
    return subprocess.run(
        [os.path.join(BIN, program), *arguments],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


class Programs(unittest.TestCase):
    def test_help_lists_commands_and_exit_codes(self):
        for program, commands in COMMANDS.items():
            shown = run(program, "--help")
            self.assertEqual((shown.returncode, shown.stderr), (0, ""))
            listed = re.findall(r"^  (\w+) {2,}\S", shown.stdout.split("Subcommands:")[1], re.MULTILINE)
            self.assertEqual([word for word in listed if not word.isdigit()], commands)
            with open(os.path.join(json_lines.SOURCE_DIR, "docs", "exit-codes.md"), encoding="utf-8") as page:
                rows = re.findall(r"^\| (\d+) \| .* \|(.*)\|(.*)\|(.*)\|$", page.read(), re.MULTILINE)
            column = list(COMMANDS).index(program) + 1
            self.assertEqual(
                [word for word in listed if word.isdigit()], [row[0] for row in rows if "x" in row[column]]
            )

    def test_each_command_has_its_help(self):
        for program, commands in COMMANDS.items():
            for command in commands:
                shown = run(program, command, "--help")
                self.assertEqual((shown.returncode, shown.stderr), (0, ""), command)
                self.assertIn(f"Usage: {program} {command}", shown.stdout)

    def test_version_says_commit_and_instruction_set(self):
        for program in COMMANDS:
            shown = run(program, "--version")
            self.assertEqual((shown.returncode, shown.stderr), (0, ""))
            self.assertRegex(
                shown.stdout,
                rf"\A{program} \d+\.\d+\.\d+ \(commit ([0-9a-f]{{9,}}(-dirty)?|unknown), x86-64[^)]*\)\n\Z",
            )

    def test_wrong_usage_says_what_was_meant(self):
        for program, arguments, sentence in [
            ("drtv", [], "a command is required; drtv --help says more"),
            ("bake", [], "a command is required; bake --help says more"),
            ("bakerd", [], "a command is required; bakerd --help says more"),
            ("drtv", ["valdate"], 'there is no command "valdate". Did you mean "validate"? drtv --help says more'),
            ("bake", ["submt", "x"], 'there is no command "submt". Did you mean "submit"? bake --help says more'),
            ("bakerd", ["fly"], 'there is no command "fly"; bakerd --help says more'),
            ("bake", ["pull", "1", "--ot=x"],
             'pull: there is no option "--ot". Did you mean "--out"? bake pull --help says more'),
            ("bake", ["list", "--sever", "x"],
             'list: there is no option "--sever". Did you mean "--server"? bake list --help says more'),
            ("bakerd", ["render", "--shw", "all"],
             'render: there is no option "--shw". Did you mean "--show"? bakerd render --help says more'),
            ("bakerd", ["serve"], "serve: --data is required; bakerd serve --help says more"),
            ("bake", ["submit", "x", "--set", "ray=5"],
             'there is no setting "ray". Did you mean "rays"? bake submit --help lists them'),
            ("bake", ["submit", "x", "--set", "rays=5"], "rays must be a number from 16 to 65536, not '5'"),
            ("bake", ["submit", "x", "--set", "rays"], "--set takes key=value, not 'rays'"),
            ("bake", ["submit", "x", "--preset", "drft"],
             'there is no preset "drft". Did you mean "draft"? bake submit --help lists them'),
            ("bake", ["submit", "x", "--region", "1,2,3"], "the region '1,2,3' is not X0,Y0,X1,Y1 in metres"),
            ("bake", ["watch", "1", "--timeout", "-1"],
             'watch: --timeout: takes a number between 0 and 1e+08, not "-1"; bake watch --help says more'),
        ]:  # fmt: skip
            with self.subTest(program=program, arguments=arguments):
                done = run(program, *arguments)
                self.assertEqual((done.returncode, done.stdout), (USAGE, ""))
                self.assertEqual(done.stderr, f"{program}: {sentence}\n")

    def test_without_a_server_bake_ends_with_7(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "map.gltf")
            with open(path, "w", encoding="utf-8") as file:
                file.write('{"asset": {"version": "2.0"}}')
            for arguments in (["list"], ["status", "1"], ["submit", path], ["pull", "1", "--out", folder]):
                done = run("bake", "--server", NOWHERE, *arguments)
                self.assertEqual((done.returncode, done.stdout), (SERVER, ""), arguments)
                self.assertEqual(
                    done.stderr, f"bake: cannot reach bakerd at {NOWHERE}: is it running?\n", arguments
                )

    def test_errors_are_objects_under_json(self):
        for program, arguments, code in [
            ("drtv", ["validate", "--json", "/nowhere"], UNREADABLE),
            ("drtv", ["diff", "/nowhere", "/nowhere", "--json"], UNREADABLE),
            ("drtv", ["validate", "--json", "--fast"], USAGE),
            ("bake", ["--json", "status", "1", "--server", NOWHERE], SERVER),
            ("bake", ["status", "1", "--json", "--server", NOWHERE], SERVER),
            ("bake", ["--json", "submit", "/nowhere.gltf"], UNREADABLE),
            ("bake", ["--json"], USAGE),
        ]:
            with self.subTest(program=program, arguments=arguments):
                done = run(program, *arguments)
                self.assertEqual(done.returncode, code)
                self.assertEqual(done.stderr.count("\n"), 1)
                self.assertIn(f'"exit_code":{code}', done.stderr)
                text = json_lines.messages_as_text(done.stderr)
                self.assertTrue(text.startswith(f"{program}: "), text)

    def test_a_full_disk_behind_a_redirection_is_no_success(self):
        for program, arguments in [("drtv", ["issues"])] + [
            (program, [word]) for program in COMMANDS for word in ("--help", "--version")
        ]:
            with open("/dev/full", "wb") as full:
                done = subprocess.run(
                    [os.path.join(BIN, program), *arguments],
                    stdout=full,
                    stderr=subprocess.PIPE,
                    text=True,
                    timeout=60,
                )
            self.assertEqual(
                (done.returncode, done.stderr), (UNREADABLE, f"{program}: cannot write to standard output\n")
            )


class Schemas(unittest.TestCase):
    def test_they_are_schemas_and_refuse_what_they_should(self):
        for key in json_lines.SCHEMAS:
            schema = json_lines.validator(key)
            for wrong in (
                {},
                [],
                "text",
                {"kind": "job"},
                {"kind": "error", "program": "bake", "message": "x"},
            ):
                self.assertFalse(schema.is_valid(wrong), (key, wrong))
        messages = json_lines.validator("messages")
        error = {"kind": "error", "program": "drtv", "message": "x", "exit_code": 2}
        self.assertTrue(messages.is_valid(error))
        for change in (
            {"exit_code": 4},
            {"exit_code": 0},
            {"program": "baker"},
            {"message": ""},
            {"more": 1},
        ):
            self.assertFalse(messages.is_valid({**error, **change}), change)
        self.assertTrue(messages.is_valid({"kind": "warning", "program": "drtv", "message": "x"}))
        self.assertFalse(messages.is_valid({**error, "kind": "warning"}))


if __name__ == "__main__":
    del sys.argv[1:]
    unittest.main()
