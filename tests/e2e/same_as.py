#!/usr/bin/env python3
"""Bakes maps with this working tree and with a commit, and compares every sector file byte for byte.

  same_as.py COMMIT [--bin DIR] [--only NAME ...]

The guard of a change that must not change a byte. The commit is built beside the tree, in build/same_as, once; --bin
is where this tree's bakerd and bake are (build/ci/bin when not said). Bakes the demo's island, and the real maps
among BAKES that ../shared/data has; what the commit baked is kept for the next run. Exits with 1 when a file differs or is missing on one side.
"""
import argparse
import hashlib
import os
import subprocess
import sys
import tempfile

from farm_fixture import SOURCE_DIR, Farm, make_island, read_folder

SHARED_DATA = os.path.join(os.path.dirname(SOURCE_DIR), "shared", "data")

# Name, map (None: the demo's island), arguments of `bake submit`. The island's villages have interiors.
BAKES = [
    ("island", None, ["--preset", "console"]),
    ("village", None, ["--preset", "pc", "--set", "rays=512", "--region", "-130,-130,130,130"]),
    ("volcano", "maps/volcano_island.glb", ["--preset", "console"]),
    (
        "volcano_error",
        "maps/volcano_island.glb",
        ["--preset", "draft", "--set", "rays=4096", "--set", "error=0.02"],
    ),
    ("sponza", "C_sponza/sponza.gltf", ["--preset", "pc"]),
    ("rooms", "C_zdm2/zdm2.glb", ["--preset", "console"]),
]


def build(commit):
    """The folder of the commit's programs."""
    sha = subprocess.run(
        ["git", "-C", SOURCE_DIR, "rev-parse", "--verify", commit + "^{commit}"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout.strip()
    tree = os.path.join(SOURCE_DIR, "build", "same_as", sha)
    if not os.path.isdir(tree):
        subprocess.run(["git", "-C", SOURCE_DIR, "worktree", "add", "--detach", tree, sha], check=True)
    subprocess.run(
        ["cmake", "--preset", "release", "-DDRTV_BUILD_TESTS=OFF"],
        cwd=tree,
        check=True,
        stdout=subprocess.DEVNULL,
    )
    subprocess.run(
        ["cmake", "--build", "--preset", "release", "--target", "bakerd", "bake"],
        cwd=tree,
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return os.path.join(tree, "build", "release", "bin")


def baked(bin_dir, map_path, arguments):
    """File name -> bytes."""
    farm = Farm(bin_dir)
    try:
        daemon = farm.daemon()
        done = farm.bake(
            daemon, "submit", map_path, *arguments, "--wait", "--pull", farm.path("sectors"), timeout=3600
        )
        daemon.stop()
        if done.returncode != 0:
            raise SystemExit(f"same_as.py: {bin_dir}/bake ended with {done.returncode}: {done.stderr}")
        return read_folder(farm.path("sectors"))
    finally:
        farm.close()


def baked_once(bin_dir, map_path, arguments):
    """As `baked`, of programs that do not change: what they baked is kept beside them."""
    with open(map_path, "rb") as file:
        key = hashlib.sha256(repr(arguments).encode() + file.read()).hexdigest()
    kept = os.path.join(os.path.dirname(bin_dir), "same_as_" + key)
    if not os.path.isdir(kept):
        with tempfile.TemporaryDirectory(dir=os.path.dirname(bin_dir)) as scratch:
            for name, content in baked(bin_dir, map_path, arguments).items():
                with open(os.path.join(scratch, name), "wb") as file:
                    file.write(content)
            os.rename(scratch, kept)
            os.mkdir(scratch)
    return read_folder(kept)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("commit")
    parser.add_argument("--bin", default=os.path.join(SOURCE_DIR, "build", "ci", "bin"))
    parser.add_argument(
        "--only",
        nargs="*",
        default=[name for name, _, _ in BAKES],
        choices=[name for name, _, _ in BAKES],
        metavar="NAME",
    )
    options = parser.parse_args()
    other_bin = build(options.commit)
    differing = compared = 0
    with tempfile.TemporaryDirectory(prefix="drtv_same_as_") as scratch:
        island = make_island(os.path.join(scratch, "island"), 2500)
        for name, map_path, arguments in BAKES:
            if name not in options.only:
                continue
            path = os.path.join(SHARED_DATA, map_path) if map_path else island
            if not os.path.exists(path):
                print(f"{name}: skipped, there is no {path}")
                continue
            ours, theirs = baked(options.bin, path, arguments), baked_once(other_bin, path, arguments)
            names = sorted(ours.keys() | theirs.keys())
            different = [file for file in names if ours.get(file) != theirs.get(file)]
            print(
                f"{name}: {len(names)} files, {len(different)} differ"
                + (f": {' '.join(different[:8])}" if different else ""),
                flush=True,
            )
            compared += len(names)
            differing += len(different)
    return 1 if differing or not compared else 0


if __name__ == "__main__":
    sys.exit(main())
