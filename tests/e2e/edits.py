#!/usr/bin/env python3
"""Random edits of a map: after each, what an incremental rebake gives is compared with a bake from nothing in a fresh data folder.

  edits.py --bin DIR [--edits N] [--sequence N] [--seed S] [--rays N] [--plants N] [--region X0,Y0,X1,Y1] [--generator COMMAND]

At tolerance 0 every byte must be the same. At the default tolerance no coefficient may differ by more than the tolerance. A sequence of edits builds on each other, then the map is
as it was at first. A failing edit is replayed by --seed of its sequence (told) and --edits up to its number.

The map is the demo's island, or what a generator writes: a command that takes -o FILE, and --edit KIND --edit-seed S for each edit.
"""
import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "format"))

import map_edits
import sector_file
from farm_fixture import Farm, make_island, read_folder

TOLERANCE = 1 / 512
# Shares of coefficients' ranges (bakerd/reuse/assessment.h), and half a step of their fixed point on both sides.
STATIC_RANGE = 0.25
ROUNDING = 2.0**-13


def probe_error(a, b):
    """The largest difference of a coefficient, as a share of its range."""
    worst = max(abs(x - y) for x, y in zip(a["sky_visibility"], b["sky_visibility"]))
    for channel_a, channel_b in zip(a["transfer"], b["transfer"]):
        for row_a, row_b in zip(channel_a, channel_b):
            worst = max(
                worst,
                abs(row_a[0] - row_b[0]) / 0.2821,
                *(abs(x - y) / 0.9772 for x, y in zip(row_a[1:], row_b[1:])),
            )
    return worst


def light_error(light_a, light_b):
    """The same of static irradiance, which may be missing."""
    light_a, light_b = (light or [[0.0] * 4] * 3 for light in (light_a, light_b))
    full = max(STATIC_RANGE, max(x for channel in light_a for x in channel))
    return max(abs(x - y) for ca, cb in zip(light_a, light_b) for x, y in zip(ca, cb)) / full


def lights_of(file, probe):
    """By light group; the name of none is None."""
    groups = dict(zip(file.get("light_groups", []), probe.get("light_groups", [])))
    return {None: probe.get("static_irradiance"), **groups}


def lights_error(first, second, p, q):
    """Of all light groups of two probes."""
    lights_p, lights_q = lights_of(first, p), lights_of(second, q)
    return max(light_error(lights_p.get(name), lights_q.get(name)) for name in lights_p | lights_q)


def file_error(a, b):
    """Of two files of one sector; infinite when their probes stand elsewhere."""
    first, second = sector_file.read(a), sector_file.read(b)
    if [p["position"] for p in first["probes"]] != [p["position"] for p in second["probes"]] or first[
        "grid"
    ] != second["grid"]:
        return float("inf")
    return max(
        (
            max(probe_error(p, q), lights_error(first, second, p, q))
            for p, q in zip(first["probes"], second["probes"])
        ),
        default=0.0,
    )


class DemoMap:
    """The demo's island, edited in place."""

    NOTHING_TO_BAKE = map_edits.NOTHING_TO_BAKE

    def __init__(self, farm, plants):
        self.farm = farm
        self.first = make_island(tempfile.mkdtemp(dir=farm.scratch.name), plants)
        self.start()

    def start(self):
        self.edited = map_edits.EditableMap(self.first)

    def edit(self, seed):
        """The path of the map after one more edit, its kind, and what it did."""
        kind, what = map_edits.edit(self.edited, seed)
        return self.edited.write(self.farm.path("map")), kind, what


class GeneratedMap:
    """Written anew for each edit, with all edits so far."""

    KINDS = (
        "move_tree",
        "delete_tree",
        "add_hut",
        "recolor_terrain_tile",
        "raise_terrain_tile",
        "move_light",
        "edit_shared_mesh",
        "add_probe",
        "rename_node",
        "reorder_buffers",
    )
    NOTHING_TO_BAKE = ("rename_node", "reorder_buffers")

    def __init__(self, farm, command):
        self.farm, self.command = farm, command.split()
        self.start()
        self.first = self.write(farm.path("first.glb"))[0]

    def start(self):
        self.edits = []

    def write(self, path):
        done = subprocess.run(
            [*self.command, *self.edits, "-o", path], capture_output=True, text=True, check=True
        )
        return path, done.stderr.strip().splitlines()

    def edit(self, seed):
        kind = random.Random(seed).choice(self.KINDS)
        self.edits += ["--edit", kind, "--edit-seed", str(seed)]
        path, told = self.write(self.farm.path("map.glb"))
        return path, kind, told[-1]


class Trial:
    def __init__(self, options, farm):
        self.options, self.farm = options, farm
        self.settings = ["--preset", "draft", "--set", f"rays={options.rays}"] + (
            [f"--region={options.region}"] if options.region else []
        )
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
            print(
                f"FAILED {title}: at tolerance 0 {len(wrong)} files differ: {', '.join(wrong[:5])}",
                flush=True,
            )
        error = max(
            (file_error(near[name], fresh[name]) for name in fresh if near.get(name) != fresh[name]),
            default=0.0,
        )
        self.largest_error = max(self.largest_error, error)
        if error > TOLERANCE + ROUNDING:
            self.failures += 1
            print(
                f"FAILED {title}: a coefficient is {error:.3g} of its range off, over the tolerance of {TOLERANCE:.3g}",
                flush=True,
            )
        return error

    def run_sequence(self, map_, seed, edits):
        exact_daemon, near_daemon = (
            self.farm.daemon(f"{kind}_{seed}", "--threads", "2") for kind in ("exact", "near")
        )
        first, _ = self.bake(exact_daemon, map_.first, f"exact_files_{seed}", "--exact")
        self.bake(near_daemon, map_.first, f"near_files_{seed}")
        map_.start()
        for number in range(edits):
            path, kind, what = map_.edit(seed * 1000 + number)
            exact, exact_job = self.bake(exact_daemon, path, f"exact_files_{seed}", "--exact")
            near, near_job = self.bake(near_daemon, path, f"near_files_{seed}")
            fresh_daemon = self.farm.daemon("fresh", "--threads", "2")
            shutil.rmtree(self.farm.path("fresh_files"), ignore_errors=True)
            fresh, _ = self.bake(fresh_daemon, path, "fresh_files", "--exact")
            fresh_daemon.stop()
            shutil.rmtree(self.farm.path("fresh"))
            title = f"seed {seed}, edit {number} ({what})"
            error = self.compare(
                title, {n: exact.get(n) for n in fresh}, {n: near.get(n) for n in fresh}, fresh
            )
            baked = exact_job["sectors_total"] - exact_job["sectors_cached"]
            print(
                f"{title}: baked {baked} of {exact_job['sectors_total']} exactly, {near_job['sectors_total'] - near_job['sectors_cached'] - near_job['sectors_near']} and {near_job['sectors_near']} near hits "
                f"(bound {near_job['largest_bound']:.2g}) by default, error {error:.2g}",
                flush=True,
            )
            if kind in map_.NOTHING_TO_BAKE and baked:
                self.failures += 1
                print(f"FAILED {title}: there was nothing to bake", flush=True)
        undone, job = self.bake(exact_daemon, map_.first, f"undone_files_{seed}", "--exact")
        if undone != first or job["sectors_cached"] != job["sectors_total"]:
            self.failures += 1
            print(
                f"FAILED seed {seed}: undone, {job['sectors_cached']} of {job['sectors_total']} sectors hit",
                flush=True,
            )
        for daemon in (exact_daemon, near_daemon):
            daemon.stop()
            shutil.rmtree(daemon.folder)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="folder of bakerd, bake and drtv")
    parser.add_argument("--edits", type=int, default=200)
    parser.add_argument("--sequence", type=int, default=50, help="edits that build on each other")
    parser.add_argument("--seed", type=int, default=1, help="of the first sequence")
    parser.add_argument("--rays", type=int, default=256)
    parser.add_argument("--plants", type=int, default=6000)
    parser.add_argument("--region", default="")
    parser.add_argument("--generator", help="a command that writes the map and its edits")
    options = parser.parse_args()
    farm = Farm(options.bin)
    try:
        trial = Trial(options, farm)
        map_ = GeneratedMap(farm, options.generator) if options.generator else DemoMap(farm, options.plants)
        for number, start in enumerate(range(0, options.edits, options.sequence)):
            trial.run_sequence(map_, options.seed + number, min(options.sequence, options.edits - start))
    finally:
        farm.close()
    print(
        f"{options.edits} edits, {trial.failures} failures, largest error {trial.largest_error:.3g} of {TOLERANCE:.3g}"
    )
    return 1 if trial.failures else 0


if __name__ == "__main__":
    sys.exit(main())
