"""The C face: a program in C11 that uses every part of it gets the numbers of `drtv relight`. Usage: SCRIPT DRTV LIBRARY INCLUDE,... GOLDEN"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

DRTV, LIBRARY, INCLUDES, GOLDEN = sys.argv[1:5]
USER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "c_user.c")
LIGHT = "--sky-colours 0.2,0.4,0.9,0.5,0.6,0.7,0.3,0.2,0.1 --sun 2,2,2 --sun-direction 3,4,12 --group lanterns=1,2,3".split()
STATUS = ["inside", "fading", "no_sector", "no_probe"]


class CFace(unittest.TestCase):
    def test_a_program_in_c_gets_the_numbers_of_the_tool(self):
        for compiler in ("gcc", "clang-14"):
            with tempfile.TemporaryDirectory() as folder:
                program = os.path.join(folder, "user")
                command = [
                    compiler,
                    "-std=c11",
                    "-Wall",
                    "-Wextra",
                    "-Wpedantic",
                    "-Werror",
                    USER,
                    "-o",
                    program,
                ]
                command += [f"-I{path}" for path in INCLUDES.split(",")] + [LIBRARY]
                subprocess.run(command, check=True)
                indoors = set()
                for at in ("-40,150,12", "-10.5,170,9", "-62,188,30", "10,150,12", "1e9,0,0", "-16,177,12"):
                    indoors.add(self.expect_same(program, os.path.dirname(LIBRARY), at))
                self.assertEqual(indoors, {"0", "1"})

    def expect_same(self, program, library_folder, at):
        environment = dict(os.environ, LD_LIBRARY_PATH=library_folder)
        found = subprocess.run(
            [program, GOLDEN, *at.split(",")], env=environment, capture_output=True, text=True
        )
        self.assertEqual(found.returncode, 0, found)
        lines = found.stdout.splitlines()
        self.expect_line(lines[0], at)
        window = ["--by", "volume", "--camera", at]
        self.expect_line(lines[1], at, *window, tolerance=2e-3)  # another size of window, halves
        return lines[2]

    def expect_line(self, line, at, *options, tolerance=1e-6):
        lamp = f"{at},1,2,3"
        told = subprocess.run(
            [DRTV, "relight", GOLDEN, "--at", at, "--normal", "0,0,1", "--light", lamp, "--json"]
            + [*LIGHT, *options],
            capture_output=True,
            check=True,
        )
        expected = json.loads(told.stdout)
        status, *colour = line.split()
        self.assertEqual(STATUS[int(status)], expected["status"])
        for channel, value in zip(colour, expected["colour"]):
            self.assertAlmostEqual(float(channel), value, delta=tolerance * max(1, value))

    def test_the_library_shows_the_names_of_its_header_alone(self):
        listing = subprocess.run(
            ["nm", "-D", "--defined-only", LIBRARY], capture_output=True, text=True, check=True
        )
        names = {line.split()[-1] for line in listing.stdout.splitlines()}
        with open(os.path.join(INCLUDES.split(",")[0], "drtv", "drtv.h"), encoding="utf-8") as file:
            header = file.read()
        for name in names:
            self.assertTrue(name.startswith("drtv_") and f"{name}(" in header, name)
        self.assertGreater(len(names), 30)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
