#!/usr/bin/env python3
"""Random edits of a map: after each, what an incremental rebake gives is compared with a bake from nothing in a fresh data folder.

  edits.py --bin DIR [--edits N] [--sequence N] [--seed S] [--rays N] [--plants N] [--region X0,Y0,X1,Y1]

At tolerance 0 every byte must be the same. At the default tolerance no coefficient may differ by more than the tolerance. A sequence of edits builds on each other, then the map is
as it was at first. A failing edit is replayed by --seed of its sequence (told) and --edits up to its number.
"""
import argparse
import os
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "format"))

import map_edits
import sector_file
from farm_fixture import Farm, make_island, read_folder

TOLERANCE = 1 / 512
# Shares of coefficients' ranges (bakerd/bake/assessment.h), and half a step of their fixed point on both sides.
STATIC_RANGE = 0.25
ROUNDING = 2.0 ** -13


def probe_error(a, b):
    """The largest difference of a coefficient, as a share of its range."""
    worst = max(abs(x - y) for x, y in zip(a["sky_visibility"], b["sky_visibility"]))
    for channel_a, channel_b in zip(a["transfer"], b["transfer"]):
        for row_a, row_b in zip(channel_a, channel_b):
            worst = max(worst, abs(row_a[0] - row_b[0]) / 0.2821, *(abs(x - y) / 0.9772 for x, y in zip(row_a[1:], row_b[1:])))
    light_a, light_b = (p.get("static_irradiance") or [[0.0] * 4] * 3 for p in (a, b))
    full = max(STATIC_RANGE, max(x for channel in light_a for x in channel))
    return max(worst, max(abs(x - y) for ca, cb in zip(light_a, light_b) for x, y in zip(ca, cb)) / full)


def file_error(a, b):
    """Of two files of one sector; infinite when their probes stand elsewhere."""
    first, second = sector_file.read(a), sector_file.read(b)
    if [p["position"] for p in first["probes"]] != [p["position"] for p in second["probes"]] or first["grid"] != second["grid"]:
        return float("inf")
    return max((probe_error(p, q) for p, q in zip(first["probes"], second["probes"])), default=0.0)


class Trial:
    def __init__(self, options, farm):
        self.options, self.farm = options, farm
        self.settings = ["--preset", "draft", "--set", f"rays={options.rays}"] + ([f"--region={options.region}"] if options.region else [])
        self.failures, self.largest_error = 0, 0.0

    def bake(self, daemon, path, name, *more):
        folder = self.farm.path(name)
        done = self.farm.bake(daemon, "--json", "submit", path, *self.settings, *more, "--pull", folder)
        if done.returncode != 0:
            raise AssertionError(done.stderr + done.stdout)
        number = done.stdout.splitlines()[-1].split('"job":"')[1].split('"')[0]
        return read_folder(folder), self.farm.job(daemon, number)

    def compare(self, title, exact, near, fresh):
        wrong = sorted(name for name in fresh if exact.get(name) != fresh[name])
        if wrong:
            self.failures += 1
            print(f"FAILED {title}: at tolerance 0 {len(wrong)} files differ: {', '.join(wrong[:5])}", flush=True)
        error = max((file_error(near[name], fresh[name]) for name in fresh if near.get(name) != fresh[name]), default=0.0)
        self.largest_error = max(self.largest_error, error)
        if error > TOLERANCE + ROUNDING:
            self.failures += 1
            print(f"FAILED {title}: a coefficient is {error:.3g} of its range off, over the tolerance of {TOLERANCE:.3g}", flush=True)
        return error

    def run_sequence(self, first_map, seed, edits):
        exact_daemon, near_daemon = (self.farm.daemon(f"{kind}_{seed}", "--threads", "2") for kind in ("exact", "near"))
        first, _ = self.bake(exact_daemon, first_map, f"exact_files_{seed}", "--exact")
        self.bake(near_daemon, first_map, f"near_files_{seed}")
        edited = map_edits.EditableMap(first_map)
        for number in range(edits):
            kind, what = map_edits.edit(edited, seed * 1000 + number)
            path = edited.write(self.farm.path(f"map_{seed}"))
            exact, exact_job = self.bake(exact_daemon, path, f"exact_files_{seed}", "--exact")
            near, near_job = self.bake(near_daemon, path, f"near_files_{seed}")
            fresh_daemon = self.farm.daemon("fresh", "--threads", "2")
            shutil.rmtree(self.farm.path("fresh_files"), ignore_errors=True)
            fresh, _ = self.bake(fresh_daemon, path, "fresh_files", "--exact")
            fresh_daemon.stop()
            shutil.rmtree(self.farm.path("fresh"))
            title = f"seed {seed}, edit {number} ({what})"
            error = self.compare(title, {n: exact.get(n) for n in fresh}, {n: near.get(n) for n in fresh}, fresh)
            baked = exact_job["sectors_total"] - exact_job["sectors_cached"]
            print(f"{title}: baked {baked} of {exact_job['sectors_total']} exactly, {near_job['sectors_total'] - near_job['sectors_cached'] - near_job['sectors_near']} and {near_job['sectors_near']} near hits "
                  f"(bound {near_job['largest_bound']:.2g}) by default, error {error:.2g}", flush=True)
            if kind in map_edits.NOTHING_TO_BAKE and baked:
                self.failures += 1
                print(f"FAILED {title}: there was nothing to bake", flush=True)
        undone, job = self.bake(exact_daemon, first_map, f"undone_files_{seed}", "--exact")
        if undone != first or job["sectors_cached"] != job["sectors_total"]:
            self.failures += 1
            print(f"FAILED seed {seed}: undone, {job['sectors_cached']} of {job['sectors_total']} sectors hit", flush=True)
        for daemon in (exact_daemon, near_daemon):
            daemon.stop()
            shutil.rmtree(daemon.folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", required=True, help="folder of bakerd, bake and drtv")
    parser.add_argument("--edits", type=int, default=200)
    parser.add_argument("--sequence", type=int, default=50, help="edits that build on each other")
    parser.add_argument("--seed", type=int, default=1, help="of the first sequence")
    parser.add_argument("--rays", type=int, default=256)
    parser.add_argument("--plants", type=int, default=6000)
    parser.add_argument("--region", default="")
    options = parser.parse_args()
    farm = Farm(options.bin)
    try:
        trial = Trial(options, farm)
        first_map = make_island(tempfile.mkdtemp(dir=farm.scratch.name), options.plants)
        for number, start in enumerate(range(0, options.edits, options.sequence)):
            trial.run_sequence(first_map, options.seed + number, min(options.sequence, options.edits - start))
    finally:
        farm.close()
    print(f"{options.edits} edits, {trial.failures} failures, largest error {trial.largest_error:.3g} of {TOLERANCE:.3g}")
    return 1 if trial.failures else 0


if __name__ == "__main__":
    sys.exit(main())
