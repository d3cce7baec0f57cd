#!/usr/bin/env python3
"""What an edit costs: the demo's island, baked whole, submitted again as it is, and with one tree moved.

  edit_bench.py --bin DIR [--preset draft|console|pc] [--trees N] [--plants N]

Prints medians over the trees: sectors baked, seconds from submit to the first and to the last new file, at tolerance 0 and by default. Everything counts: hashing, upload, import, assessment,
baking, pulling.
"""
import argparse
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time

import map_edits
from farm_fixture import Farm, make_island


def timed_submit(farm, daemon, path, preset, folder, *more):
    """Seconds to the first new file (None without any) and to the end, and the job."""
    before = (
        {entry.name: entry.stat().st_mtime_ns for entry in os.scandir(folder)}
        if os.path.isdir(folder)
        else {}
    )
    start = time.monotonic()
    process = subprocess.Popen(
        [
            os.path.join(farm.bin_dir, "bake"),
            "--server",
            daemon.address,
            "--json",
            "submit",
            path,
            "--preset",
            preset,
            *more,
            "--pull",
            folder,
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    first = None
    while process.poll() is None:
        if first is None and os.path.isdir(folder):
            if any(
                entry.name.endswith(".drtv") and before.get(entry.name) != entry.stat().st_mtime_ns
                for entry in os.scandir(folder)
            ):
                first = time.monotonic() - start
        time.sleep(0.005)
    seconds = time.monotonic() - start
    output, errors = process.communicate()
    if process.returncode != 0:
        raise SystemExit(errors + output)
    return first, seconds, farm.job(daemon, output.splitlines()[-1].split('"job":"')[1].split('"')[0])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True)
    parser.add_argument("--preset", default="draft")
    parser.add_argument("--trees", type=int, default=7)
    parser.add_argument("--plants", type=int, default=6000)
    options = parser.parse_args()
    farm = Farm(options.bin)
    try:
        first_map = make_island(tempfile.mkdtemp(dir=farm.scratch.name), options.plants)
        daemon = farm.daemon("data")
        _, full_s, job = timed_submit(farm, daemon, first_map, options.preset, farm.path("files"), "--exact")
        sectors = job["sectors_total"]
        print(f"{options.preset}: {sectors} sectors from nothing in {full_s:.2f} s", flush=True)
        again = statistics.median(
            timed_submit(farm, daemon, first_map, options.preset, farm.path("files"), "--exact")[1]
            for _ in range(5)
        )
        print(f"submitted again, all hits: {again:.2f} s", flush=True)
        rows = {"exact": [], "default": []}
        for number in range(options.trees):
            edited = map_edits.EditableMap(first_map)
            edited_what = map_edits.move_plant(edited, random.Random(number))
            path = edited.write(farm.path(f"map_{number}"))
            # By default first: the exact results would be hits for it.
            for mode, more in (("default", []), ("exact", ["--exact"])):
                seconds = timed_submit(farm, daemon, path, options.preset, farm.path("files"), *more)
                baked = (
                    seconds[2]["sectors_total"] - seconds[2]["sectors_cached"] - seconds[2]["sectors_near"]
                )
                if mode == "exact":  # on top of what the default job has baked
                    baked += rows["default"][-1][0]
                    seconds = (seconds[0], seconds[1] + rows["default"][-1][2], seconds[2])
                rows[mode].append((baked, seconds[0], seconds[1]))
            print(
                f"  {edited_what}: default {rows['default'][-1][0]} sectors in {rows['default'][-1][2]:.2f} s, exact {rows['exact'][-1][0]} in {rows['exact'][-1][2]:.2f} s or less",
                flush=True,
            )
        for mode, results in rows.items():
            baked, last = (statistics.median(r[k] for r in results) for k in (0, 2))
            firsts = [r[1] for r in results if r[1] is not None]
            first = (
                f", first file after {statistics.median(firsts):.2f} s"
                if firsts and mode == "default"
                else ""
            )
            allowed = (
                f" (share of the full bake + 1 s: {baked / sectors * full_s + 1:.2f} s)"
                if mode == "exact"
                else ""
            )
            print(
                f"one tree moved, {mode}: {baked:.0f} of {sectors} sectors baked, {last:.2f} s{first}{allowed}",
                flush=True,
            )
    finally:
        farm.close()


if __name__ == "__main__":
    sys.exit(main())
