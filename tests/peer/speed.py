#!/usr/bin/env python3
"""How much faster is drtv than Cycles, at equal error? See README.md.

speed.py --bin DIR MAP --region X0,Y0,X1,Y1: E/pi in the four basis directions under the four skies, at the region's
probes, to TARGET_ERROR of its mean. Start and scene build count for neither. Times are CPU seconds of all threads: both
keep as many threads busy as they are given, and a shared machine's wall clock shows mostly its other tenants.
"""
import argparse
import math
import os
import statistics
import sys

from measure import BASIS, SKIES, bake, evenly, open_farm, run_cycles

TARGET_ERROR = 0.01  # rms error over the mean, of E/pi over all probes, directions, skies and channels
TRUTH_RAYS = 65536
ROUNDS = 3  # of timings, the two in turn; medians count
MANY_RAYS, FEW_RAYS = 60000, 20000  # two bakes' difference in time is that in rays
MANY_SAMPLES, FEW_SAMPLES = 1024, 64  # likewise, of Cycles
SKY_SAMPLINGS = ("NONE", "MANUAL")  # Cycles scatters only, or aims at the sky too; its better one counts


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map")
    parser.add_argument("--bin", required=True, help="folder of bakerd, bake and drtv")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--region", required=True)
    parser.add_argument("--reach", type=float, default=4000)
    parser.add_argument("--bounces", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument(
        "--probes", type=int, default=40, help="for Cycles at most so many; costs are compared a probe"
    )
    parser.add_argument("--replicas", type=int, default=4, help="of Cycles, to measure its error")
    options = parser.parse_args(arguments)
    options.set, options.lattice = [], None
    return options


def open_sky(b, axis, steps=64):
    """E/pi around direction b under a whole sky of radiance 1 + axis . w, by the midpoint rule."""
    total = 0.0
    for i in range(steps):
        z = (i + 0.5) / steps
        r = math.sqrt(1 - z * z)
        for j in range(4 * steps):
            turn = 2 * math.pi * (j + 0.5) / (4 * steps)
            w = (r * math.cos(turn), r * math.sin(turn), z)
            total += max(0.0, sum(p * q for p, q in zip(w, BASIS[b]))) * (
                1 + sum(p * q for p, q in zip(w, axis))
            )
    return total * 2 / (4 * steps * steps)


OPEN = {sky: [open_sky(b, axis) for b in range(4)] for sky, (axis, _) in SKIES.items()}


def relit(probes):
    """E/pi by probe, sky, direction and channel, in one list. Direct light is v's share of the open sky's."""
    return [
        p["sky_visibility"][b] * OPEN[sky][b] + sum(t * s for t, s in zip(p["transfer"][c][b], coefficients))
        for p in probes
        for sky, (_, coefficients) in SKIES.items()
        for b in range(4)
        for c in range(3)
    ]


def needed(name, error_of, first):
    """How many rays or samples reach the target: between two powers by a straight line in logarithms."""
    count, before = first, None
    while True:
        error = error_of(count)
        print(f"{name}: {count}: error {100 * error:.2f} %", flush=True)
        if error <= TARGET_ERROR:
            return (
                count
                if before is None
                else count / 2 ** (math.log(TARGET_ERROR / error) / math.log(before / error))
            )
        count, before = count * 2, error


def all_light(samples):
    return [
        {"name": sky, "light": ["DIRECT", "INDIRECT"], "axis": axis, "samples": samples}
        for sky, (axis, _) in SKIES.items()
    ]


def cycles_error(farm, options, positions, sky_sampling, samples):
    """Of one replica: rms over probes, skies, directions and channels, over the mean."""
    passes = run_cycles(farm, options, positions, all_light(samples), sky_sampling)["passes"]
    groups = [
        [replica[c] for replica in direction]
        for p in passes
        for probe in p["values"]
        for direction in probe
        for c in range(3)
    ]
    return math.sqrt(statistics.fmean(map(statistics.variance, groups))) / statistics.fmean(
        value for group in groups for value in group
    )


def cycles_seconds(farm, options, positions, sky_sampling):
    """Of one sample under each sky, around each direction, at one probe."""
    passes = run_cycles(
        farm, options, positions, all_light(FEW_SAMPLES) + all_light(MANY_SAMPLES), sky_sampling
    )["passes"]
    few, many = sum(p["cpu_seconds"] for p in passes[: len(SKIES)]), sum(
        p["cpu_seconds"] for p in passes[len(SKIES) :]
    )
    return (many - few) / (MANY_SAMPLES - FEW_SAMPLES) / options.replicas / len(positions)


def worker_cpu_seconds(daemon):
    with open(f"/proc/{daemon.worker_pid()}/stat", encoding="utf-8") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def drtv_seconds(farm, daemon, options, turn):
    """Of one ray at one probe. Each turn asks for other numbers of rays: the same would come out of the cache."""
    seconds = []
    for rays in (FEW_RAYS + turn, MANY_RAYS + turn):
        begun = worker_cpu_seconds(daemon)
        probes = bake(farm, daemon, options, rays)
        seconds.append(worker_cpu_seconds(daemon) - begun)
    return (seconds[1] - seconds[0]) / (MANY_RAYS - FEW_RAYS) / len(probes)


def main():
    options = parse(sys.argv[1:])
    with open_farm(options) as (farm, daemon):
        truth = bake(farm, daemon, options, TRUTH_RAYS)
        positions = [p["position"] for p in evenly(truth, options.probes)]
        target = relit(truth)

        def drtv_error(rays):
            return math.sqrt(
                statistics.fmean(
                    (a - b) ** 2 for a, b in zip(relit(bake(farm, daemon, options, rays)), target)
                )
            ) / statistics.fmean(target)

        rays = needed("drtv, rays", drtv_error, 256)
        samples = {
            s: needed(
                f"Cycles ({s}), samples", lambda n, s=s: cycles_error(farm, options, positions, s, n), 256
            )
            for s in SKY_SAMPLINGS
        }
        drtv, cycles = [], {s: [] for s in SKY_SAMPLINGS}
        for turn in range(ROUNDS):
            drtv.append(rays * drtv_seconds(farm, daemon, options, turn))
            for s in SKY_SAMPLINGS:
                cycles[s].append(samples[s] * cycles_seconds(farm, options, positions, s))
            print(
                f"CPU ms a probe: drtv {1e3 * drtv[-1]:.3f}; Cycles "
                + ", ".join(f"{s} {1e3 * cycles[s][-1]:.1f}" for s in SKY_SAMPLINGS),
                flush=True,
            )
    best = min(statistics.median(seconds) for seconds in cycles.values())
    print(
        f"at {100 * TARGET_ERROR:g} % error, CPU time: drtv {rays:.0f} rays, {1e3 * statistics.median(drtv):.3f} ms a probe; "
        f"Cycles {', '.join(f'{n:.0f} samples ({s})' for s, n in samples.items())}, {1e3 * best:.1f} ms a probe: {best / statistics.median(drtv):.0f} x"
    )


if __name__ == "__main__":
    main()
