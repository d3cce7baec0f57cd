#!/usr/bin/env python3
"""Bakes and traces on this CPU, on this CPU with the C library's plainest functions, and on QEMU's, whose approximate reciprocal is exact;
every byte must be the same.

  same_on_cpus.py --bin build/ci/tests                          what every run of the tests does
  same_on_cpus.py --bin build/ci/tests --sectors 8 MAP.glb ...  so many sectors of each map besides
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

# Name, what stands before the command, what is added to the environment.
CPUS = [
    ("this CPU", [], {}),
    (
        "this CPU, plain C library",
        [],
        {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-AVX512F"},
    ),
    ("QEMU", ["qemu-x86_64", "-cpu", "max"], {}),
]


def differences(a, b, size):
    """How many records of so many bytes differ, those that only one has included, and the first of them."""
    differing = (
        [n for n in range(0, max(len(a), len(b)), size) if a[n : n + size] != b[n : n + size]]
        if a != b
        else []
    )
    return len(differing), differing[0] // size if differing else None


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, type=pathlib.Path, help="folder of cpu_bytes")
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--sectors", type=int, default=4, help="of each map")
    parser.add_argument("maps", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    cpus = [cpu for cpu in CPUS if not cpu[1] or shutil.which(cpu[1][0])]
    if len(cpus) < len(CPUS):
        print("qemu-x86_64 is not there, and left out: deploy/install_packages.sh --tests installs it")
    program = str(options.bin / "cpu_bytes")
    # Name, arguments before and after the output file, bytes of a record.
    works = [(f"rays, seed {seed}", ["rays", str(options.rays // 2), str(seed)], [], 8) for seed in (1, 2)]
    works += [("bake", ["bake"], [], 1)]
    works += [
        (f"bake of {path.name}", ["bake"], [str(path), str(options.sectors)], 1) for path in options.maps
    ]
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        # All at once: the emulated ones take far the longest.
        running = []
        for work, (_, before, after, _) in enumerate(works):
            for cpu, (_, prefix, environment) in enumerate(cpus):
                out = pathlib.Path(folder) / f"{work}_{cpu}"
                command = [
                    "env",
                    *(f"{key}={value}" for key, value in environment.items()),
                    *prefix,
                    program,
                    *before,
                    str(out),
                    *after,
                ]
                running.append((work, cpu, out, subprocess.Popen(command)))
        results = {}
        for work, cpu, out, process in running:
            if process.wait() != 0:
                print(f"{works[work][0]} on {cpus[cpu][0]}: ended with {process.returncode}")
                failed = True
                continue
            results[work, cpu] = out.read_bytes()
    for work, (name, _, _, size) in enumerate(works):
        for cpu in range(1, len(cpus)):
            if (work, 0) not in results or (work, cpu) not in results:
                continue
            count, first = differences(results[work, 0], results[work, cpu], size)
            total = len(results[work, 0]) // size
            print(
                f'{name}: {count} of {total} {"answers" if size > 1 else "bytes"} differ on {cpus[cpu][0]}'
                + (f", the first at {first}" if count else "")
            )
            failed = failed or count > 0 or total == 0
    return 1 if failed else 77 if len(cpus) < len(CPUS) else 0


if __name__ == "__main__":
    sys.exit(main())
