#!/usr/bin/env python3
"""How fast sector files come over loopback, beside `cp -r` of the same files: pull_bench.py --bin DIR [--sectors 100] [--rounds 5]

Bakes a plain of so many sectors a side with few rays, then pulls and copies in turns, each into an empty folder, and prints the medians. A pull
is on the disk when it ends; so is a copy only after a sync."""
import argparse
import os
import statistics
import subprocess
import time

import farm_fixture
from small_maps import write_map


def seconds_of(command):
    start = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True)
    parser.add_argument("--sectors", type=int, default=100, help="along each side")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    farm = farm_fixture.Farm(options.bin)
    try:
        daemon = farm.daemon()
        side = 64 * options.sectors - 1
        plain = write_map(
            farm.path("plain.gltf"), plain=[(1, 1, 0), (side, 1, 0), (side, side, 0), (1, side, 0)]
        )
        few = ["--set", "rays=16", "--set", "bounces=1", "--set", "reach=16"]
        done = farm.bake(daemon, "submit", plain, "--preset", "draft", *few, "--wait", "--yes", timeout=3600)
        assert done.returncode == 0, done.stderr
        bake = [os.path.join(options.bin, "bake"), "--server", daemon.address]
        pulls, copies, syncs = [], [], []
        for n in range(options.rounds):
            pulled, copied = farm.path(f"pulled{n}"), farm.path(f"copied{n}")
            pulls.append(seconds_of([*bake, "pull", "1", "--out", pulled]))
            copies.append(seconds_of(["cp", "-r", pulled, copied]))
            syncs.append(seconds_of(["sync", "--file-system", copied]))
            files = len(os.listdir(copied)) - 1
            size = sum(os.path.getsize(os.path.join(copied, name)) for name in os.listdir(copied))
        pull, copy, sync = (statistics.median(times) for times in (pulls, copies, syncs))
        print(
            f"{files} files, {size / 1e6:.0f} MB: pull {pull:.2f} s; cp {copy:.2f} s, {copy / pull:.2f} of its speed;"
            f" with sync {copy + sync:.2f} s, {(copy + sync) / pull:.2f} of its speed"
        )
    finally:
        farm.close()


if __name__ == "__main__":
    main()
