#!/usr/bin/python3
"""A table of what simulate_farm says of farms of 1 to 128 nodes.

    farm_table.py build/ci/tests/simulate_farm COSTS --sectors 25600 [more of its options]"""
import json
import subprocess
import sys

COLUMNS = {
    "nodes": lambda said: said["nodes"],
    "time": lambda said: f"{said['seconds']:,.0f} s",
    "efficiency": lambda said: f"{said['efficiency']:.2f}",
    "tasks": lambda said: f"{said['tasks']:,}",
    "started": lambda said: f"{said['tasks_per_s']:.2f}/s",
    "files": lambda said: f"{said['files_per_s']:,.0f}/s",
    "answers": lambda said: f"{said['answers_per_s']:,.0f}/s",
    "read": lambda said: f"{said['read_gb']:,.0f} GB",
    "written": lambda said: f"{said['written_gb']:,.0f} GB",
    "network": lambda said: f"{said['network_mb_s']:,.0f} MB/s",
}


def row(cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    row(COLUMNS)
    row(["---"] * len(COLUMNS))
    for nodes in (1, 2, 4, 8, 16, 32, 64, 128):
        command = [*sys.argv[1:], "--nodes", str(nodes)]
        said = json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)
        row(column(said) for column in COLUMNS.values())


if __name__ == "__main__":
    main()
