"""What the tests of the drtv tool share. Their usage: SCRIPT DRTV GOLDEN_FOLDER"""
import os
import struct
import subprocess
import sys
import tempfile
import unittest

import sector_file

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import json_lines

DRTV, GOLDEN_FOLDER = sys.argv[1:3]
GOLDEN = os.path.join(GOLDEN_FOLDER, "format_1_0.drtv")
GOLDEN_1_1 = os.path.join(GOLDEN_FOLDER, "format_1_1.drtv")
GOLDEN_1_3 = os.path.join(GOLDEN_FOLDER, "format_1_3.drtv")
USAGE, UNREADABLE, INVALID = 1, 2, 3


def drtv(*arguments, **options):
    return subprocess.run([DRTV, *arguments], capture_output=True, timeout=60, **options)


def golden(path=GOLDEN):
    with open(path, "rb") as file:
        return bytearray(file.read())


def seal(data):
    """Writes all checksums anew."""
    (count,) = struct.unpack_from("<I", data, 12)
    for entry in range(64, 64 + 32 * count, 32):
        offset, stored = struct.unpack_from("<II", data, entry + 8)
        struct.pack_into("<Q", data, entry + 24, sector_file.xxh64(bytes(data[offset : offset + stored])))
    struct.pack_into("<Q", data, 56, sector_file.xxh64(bytes(data[:56] + data[64 : 64 + 32 * count])))
    return data


def rounded(value):
    """All numbers as binary32, which is what the file holds."""
    if isinstance(value, dict):
        return {key: rounded(member) for key, member in value.items()}
    if isinstance(value, list):
        return [rounded(element) for element in value]
    return sector_file.as_float32(value) if isinstance(value, float) else value


class Tool(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb") as file:
            file.write(data)
        return self.path(name)

    def expect(self, exit_code, *arguments, err="", out=None, **options):
        """Runs and checks: the exit code, words on stderr (none: it is empty), words on stdout when asked."""
        result = drtv(*arguments, **options)
        stdout, stderr = result.stdout.decode(), result.stderr.decode()
        stderr = json_lines.read("drtv", arguments, stdout, stderr)
        self.assertEqual(result.returncode, exit_code, (arguments, stdout[-500:], stderr))
        if err:
            self.assertIn(err, stderr)
            self.assertTrue(stderr.startswith("drtv: "), stderr)
        else:
            self.assertEqual(stderr, "")
        if out is not None:
            self.assertIn(out, stdout)
        return stdout

    def broken(self, name="broken.drtv"):
        data = golden()
        data[400] ^= 1
        return self.write(name, data)
