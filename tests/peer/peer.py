#!/usr/bin/env python3
"""Bakes a map with the real daemon, measures the same probes with Blender's Cycles, and compares: see README.md.

peer.py --bin DIR MAP [--region X0,Y0,X1,Y1 | --lattice ...] [--set key=value ...]; exits 1 when the two disagree.
"""
import argparse
import json
import math
import os
import sys

from agreement import TRANSFER_STEP, VISIBILITY_STEP, Pair, agreement, complaints, mean_and_se, pooled_se
from measure import BASIS, OPEN_SKY, SKIES, bake, evenly, open_farm, run_cycles

DRTV_RAYS, DRTV_FEWER_RAYS = (
    65536,
    16384,
)  # the most there are, and a nested quarter of them to tell their noise


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", help=".gltf or .glb file")
    parser.add_argument("--bin", required=True, help="folder of bakerd, bake and drtv")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--region", help="X0,Y0,X1,Y1 in world metres: the sectors whose probes to compare")
    parser.add_argument(
        "--lattice",
        metavar="X0,Y0,Z0,X1,Y1,Z1,NX,NY,NZ",
        help="compare hand-placed probes on this lattice instead of the automatic ones",
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="as of `bake submit`; not rays, bounces or reach",
    )
    parser.add_argument("--bounces", type=int, default=3)
    parser.add_argument(
        "--reach", type=float, default=4000, help="metres; must cover the map from every probe"
    )
    parser.add_argument("--probes", type=int, default=80, help="at most so many, spread evenly over the list")
    parser.add_argument("--samples", type=int, default=256, help="of Cycles, for each replica")
    parser.add_argument("--replicas", type=int, default=32, help="independent measurements by Cycles")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--json", help="write every pair of numbers to this file")
    return parser.parse_args(arguments)


def compared(fine, coarse, quantisation_se, cycles):
    """Pairs of one quantity: a value a probe by drtv's two bakes, replicas a probe by Cycles."""
    se = math.hypot(pooled_se(fine, coarse), quantisation_se)
    return [
        Pair(n, value, se, *mean_and_se(replicas)) for n, (value, replicas) in enumerate(zip(fine, cycles))
    ]


def visibility_pairs(fine, coarse, direct):
    """v[b] o[b]: E/pi of the direct sky of radiance 1. Without direction 3, which sees no sky."""
    pairs = []
    for b in range(3):

        def of(probes):
            return [p["sky_visibility"][b] * OPEN_SKY[b] for p in probes]

        cycles = [[rgb[0] for rgb in probe[b]] for probe in direct]
        pairs += compared(of(fine), of(coarse), VISIBILITY_STEP * OPEN_SKY[b] / math.sqrt(12), cycles)
    return pairs


def transfer_pairs(fine, coarse, indirect, coefficients):
    """T . sky: E/pi of what the surfaces send back."""
    pairs = []
    quantisation_se = TRANSFER_STEP * math.sqrt(sum(s * s for s in coefficients) / 12)
    for b in range(4):
        for c in range(3):

            def of(probes):
                return [sum(t * s for t, s in zip(p["transfer"][c][b], coefficients)) for p in probes]

            cycles = [[rgb[c] for rgb in probe[b]] for probe in indirect]
            pairs += compared(of(fine), of(coarse), quantisation_se, cycles)
    return pairs


def print_table(results):
    print(
        f"{'quantity':12} {'values':>6} {'mean':>7} {'bias %':>7} {'+- %':>5} {'rms %':>6} {'noise %':>7} {'chi2/n':>6} {'worst z':>7}"
    )
    for r in results:
        print(
            f"{r.name:12} {r.values:6} {r.mean:7.4f} {100 * r.bias:7.3f} {100 * r.bias_se:5.3f} {100 * r.rms:6.2f} {100 * r.noise:7.2f} {r.chi2:6.2f} {r.worst_z:7.2f}"
        )


def main():
    options = parse(sys.argv[1:])
    with open_farm(options) as (farm, daemon):
        fine, coarse = (
            evenly(bake(farm, daemon, options, rays), options.probes) for rays in (DRTV_RAYS, DRTV_FEWER_RAYS)
        )
        daemon.stop()
        passes = [{"name": "direct", "light": ["DIRECT"], "axis": (0, 0, 0), "samples": options.samples}]
        passes += [
            {"name": sky, "light": ["INDIRECT"], "axis": axis, "samples": options.samples}
            for sky, (axis, _) in SKIES.items()
        ]
        answer = run_cycles(farm, options, [p["position"] for p in fine], passes)
    values = {p["name"]: p["values"] for p in answer["passes"]}
    pairs = {"v": visibility_pairs(fine, coarse, values["direct"])}
    pairs.update(
        {
            f"T . ({sky})": transfer_pairs(fine, coarse, values[sky], coefficients)
            for sky, (_, coefficients) in SKIES.items()
        }
    )
    lit = {p.probe for p in pairs["T . (1)"] if p.drtv or p.cycles}
    print(
        f"{os.path.basename(options.map)}: {len(fine)} probes, {len(lit)} of them lit; {options.bounces} bounces; "
        f"drtv {DRTV_RAYS} rays, Cycles {answer['blender']} {options.replicas} x {options.samples} samples"
    )
    results = [agreement(name, of) for name, of in pairs.items()]
    print_table(results)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(
                {
                    "positions": [p["position"] for p in fine],
                    "pairs": {name: [vars(p) for p in of] for name, of in pairs.items()},
                },
                file,
            )
    found = complaints(results, len(lit))
    print("\n".join(found) if found else "they agree")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
