#!/usr/bin/python3
"""What the sectors in a daemon's cache cost, for simulate_farm: seconds of one thread and bytes written, in the order of baking.

    sector_costs.py DATA_FOLDER > COSTS"""
import json
import os
import sqlite3
import sys


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = os.path.join(sys.argv[1], "farm.sqlite")
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as database:
        rows = database.execute(
            "SELECT seconds, file_bytes + footprint_bytes FROM result ORDER BY id"
        ).fetchall()
    json.dump({"sectors": [[round(seconds, 4), size] for seconds, size in rows]}, sys.stdout)


if __name__ == "__main__":
    main()
