#!/usr/bin/env python3
"""End to end with the real daemon, worker and client: e2e_test.py --bin DIR --data SHARED_DATA CASE"""
import argparse
import base64
import csv
import hashlib
import json
import os
import pty
import shutil
import signal
import sqlite3
import struct
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../format"))
import farm_fixture
import json_lines
import map_edits
import png_file
from farm_fixture import Farm, make_island, read_folder, tiny_disk, wait_until
from lines import cutting_proxy, version_server
from small_maps import LAWN, WALL, change, lawn_with_ballast, with_lamps, with_many_instances, write_map

OPTIONS = argparse.Namespace(bin="", data="")
# 36 sectors around the crater and the inland village: ground, jungle, huts, manual probes, the no_probes box.
REGION = ["--region", "-130,-190,250,120"]
FEW_RAYS = ["--preset", "draft", "--set", "rays=64"]
# docs/exit-codes.md
USAGE, UNREADABLE, INVALID, JOB_FAILED, UNFINISHED, SERVER, TIMEOUT = 1, 2, 3, 5, 6, 7, 8


def world_translation(nodes, number):
    """glTF position of a node's origin, through parents with translations and rotations."""
    point = (0.0, 0.0, 0.0)
    while number is not None:
        node = nodes[number]
        qx, qy, qz, qw = node.get("rotation", (0, 0, 0, 1))
        px, py, pz = (a * b for a, b in zip(point, node.get("scale", (1, 1, 1))))
        tx, ty, tz = 2 * (qy * pz - qz * py), 2 * (qz * px - qx * pz), 2 * (qx * py - qy * px)
        turned = (
            px + qw * tx + qy * tz - qz * ty,
            py + qw * ty + qz * tx - qx * tz,
            pz + qw * tz + qx * ty - qy * tx,
        )
        point = tuple(a + b for a, b in zip(turned, node.get("translation", (0, 0, 0))))
        number = next((n for n, parent in enumerate(nodes) if number in parent.get("children", [])), None)
    return point


def last_object(done):
    """Of what a program printed under --json."""
    return json.loads(done.stdout.splitlines()[-1])


def has_ended(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
            return file.read().split()[2] == "Z"
    except FileNotFoundError:
        return True


class FarmTest(unittest.TestCase):
    def setUp(self):
        self.farm = Farm(OPTIONS.bin)
        self.addCleanup(self.farm.close)

    def island(self, plants=700):
        return make_island(self.farm.path("map"), plants)

    def pulled(self, daemon, *arguments, name="pulled"):
        """Submits, waits, pulls; gives the files."""
        folder = self.farm.path(name)
        done = self.farm.bake(daemon, "submit", *arguments, "--pull", folder)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        return read_folder(folder)

    def dumps(self, daemon, *arguments, name="pulled"):
        """Of a bake's sectors, with any probes in them."""
        files = self.pulled(daemon, *arguments, name=name)
        dumps = [
            json.loads(
                self.farm.run("drtv", "dump", os.path.join(self.farm.path(name), file), "--json").stdout
            )
            for file in files
        ]
        return [dump for dump in dumps if dump["probes"]]

    def assert_sentence(self, done, *parts, status=None):
        """Failed, with one line on standard error that holds the parts."""
        if status is None:
            self.assertNotEqual(done.returncode, 0, done.stdout)
        else:
            self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)


class Baking(FarmTest):
    def test_region_is_baked_pulled_valid_and_pictured(self):
        daemon = self.farm.daemon()
        island = self.island()
        files = self.pulled(daemon, island, *REGION, *FEW_RAYS)
        self.assertEqual(len(files), 35)
        validated = self.farm.run(
            "drtv", "validate", "--neighbours", "--warnings-as-errors", self.farm.path("pulled"), "--json"
        )
        self.assertEqual(validated.returncode, 0, validated.stdout)
        picture = self.farm.path("map.png")
        self.assertEqual(
            self.farm.run("drtv", "preview", self.farm.path("pulled"), "--out", picture).returncode, 0
        )
        with open(picture, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")

    def test_manual_probe_stands_where_the_artist_put_it(self):
        daemon = self.farm.daemon()
        island = self.island()
        with open(island, encoding="utf-8") as file:
            nodes = json.load(file)["nodes"]
        probe = next(
            n
            for n, node in enumerate(nodes)
            if node.get("extras", {}).get("bake_role") == "probe" and "inland" in node["name"]
        )
        x, y, z = world_translation(nodes, probe)
        self.pulled(daemon, island, "--region", f"{x},{-z},{x},{-z}", *FEW_RAYS)
        (name,) = read_folder(self.farm.path("pulled"))
        dump = json.loads(
            self.farm.run("drtv", "dump", os.path.join(self.farm.path("pulled"), name), "--json").stdout
        )
        manual = [p["position"] for p in dump["probes"] if p["kind"] == "manual"]
        half_unit_m = 0.5 / 1024
        self.assertTrue(
            any(all(abs(a - b) <= half_unit_m for a, b in zip(position, (x, -z, y))) for position in manual),
            (manual, (x, -z, y)),
        )
        # It is the probe of the hut's interior, a box around it.
        rooms = [
            room
            for room in dump["interiors"]
            if all(
                abs(a - b) <= half_unit_m
                for a, b in zip(dump["probes"][room["probe"]]["position"], (x, -z, y))
            )
        ]
        self.assertEqual([(len(room["vertices"]), len(room["triangles"])) for room in rooms], [(8, 12)])
        for axis, value in enumerate((x, -z, y)):
            self.assertLess(min(vertex[axis] for vertex in rooms[0]["vertices"]), value)
            self.assertGreater(max(vertex[axis] for vertex in rooms[0]["vertices"]), value)

    def test_resubmitting_finds_every_sector_in_the_cache(self):
        daemon = self.farm.daemon()
        island = self.island(100)
        first = self.pulled(daemon, island, *REGION, *FEW_RAYS)
        again = self.farm.bake(daemon, "--json", "submit", island, *REGION, *FEW_RAYS)
        job = last_object(again)
        self.assertEqual(
            (job["state"], job["sectors_cached"], job["sectors_total"]), ("succeeded", len(first), len(first))
        )

    def test_renamed_and_reordered_map_is_the_same_map(self):
        daemon = self.farm.daemon()
        island = self.island(100)
        self.pulled(daemon, island, *REGION, *FEW_RAYS)
        with open(island, encoding="utf-8") as file:
            document = json.load(file)
        probes = {
            volume["extras"]["bake_probe"]
            for volume in document["nodes"]
            if "bake_probe" in volume.get("extras", {})
        }
        for number, node in enumerate(document["nodes"]):
            if node.get("name") not in probes:
                node["name"] = f"renamed {number}"
        document["scenes"][document.get("scene", 0)]["nodes"].reverse()
        with open(island, "w", encoding="utf-8") as file:
            json.dump(document, file)
        job = last_object(self.farm.bake(daemon, "--json", "submit", island, *REGION, *FEW_RAYS))
        self.assertEqual(job["sectors_cached"], job["sectors_total"])

    def test_wall_seen_from_behind_is_told_by_its_name(self):
        daemon = self.farm.daemon()
        warning = r"^bake: warning: sector \(0, 0\): \d+ % of its rays meet surfaces from behind, most of them those of 'garden wall'"
        turned = write_map(
            self.farm.path("turned.gltf"),
            **{
                "lawn": LAWN,
                "garden wall": WALL[::-1],
                "hatch": [(30, 1, 0), (30, 5, 0), (30, 5, 3), (30, 1, 3)],
            },
        )
        for arguments in (["submit", turned, *FEW_RAYS, "--wait"], ["watch", "1"]):
            done = self.farm.bake(daemon, *arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stderr, warning)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        right = write_map(self.farm.path("right.gltf"), **{"lawn": LAWN, "garden wall": WALL})
        done = self.farm.bake(daemon, "submit", right, *FEW_RAYS, "--wait")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_warning_of_an_odd_name_is_one_line(self):
        daemon = self.farm.daemon()
        turned = write_map(self.farm.path("turned.gltf"), **{"lawn": LAWN, "garden\nwall\x1b[2J": WALL[::-1]})
        done = self.farm.bake(daemon, "submit", turned, *FEW_RAYS, "--wait")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertNotIn("\x1b", done.stderr)

    def test_pc_preset_brings_local_transfer(self):
        daemon = self.farm.daemon()
        lawn = write_map(self.farm.path("lawn.gltf"), lawn=LAWN, wall=WALL)
        (dump,) = self.dumps(daemon, lawn, "--preset", "pc", "--set", "lprt_rays=64", "--set", "rays=256")
        self.assertGreater(len(dump["probes"]), 3)
        for probe in dump["probes"]:
            self.assertIn("local", probe)
        self.assertTrue(any(probe["local"] for probe in dump["probes"]))
        self.assertEqual((dump["convergence"]["local_bounces"], dump["convergence"]["local_rays"]), (2, 64))
        self.assertGreater(dump["convergence"]["local_transfer_rays"], 0)
        (dump,) = self.dumps(daemon, lawn, "--preset", "console", "--set", "rays=256", name="console")
        self.assertFalse(any("local" in probe for probe in dump["probes"]))

    def test_error_asked_for_ends_the_paths_within_the_budget(self):
        daemon = self.farm.daemon()
        lawn = write_map(self.farm.path("lawn.gltf"), lawn=LAWN, wall=WALL)
        (dump,) = self.dumps(daemon, lawn, "--set", "error=0.02", "--set", "rays=4096")
        convergence = dump["convergence"]
        self.assertAlmostEqual(convergence["error_asked"], 0.02, places=6)
        self.assertGreaterEqual(convergence["paths_least"], 256)
        self.assertLessEqual(convergence["paths_least"], convergence["paths_most"])
        self.assertLessEqual(convergence["paths_most"], 4096)
        if convergence["paths_most"] < 4096:
            self.assertLessEqual(convergence["error_max"], 0.02)
        # A fifth of the error takes more.
        (finer,) = self.dumps(daemon, lawn, "--set", "error=0.004", "--set", "rays=4096", name="finer")
        self.assertGreater(finer["convergence"]["paths_most"], convergence["paths_least"])
        self.assertLess(finer["convergence"]["error_median"], convergence["error_median"])
        # And without it all of the budget is used.
        (plain,) = self.dumps(daemon, lawn, "--set", "rays=1024", name="plain")
        self.assertEqual(
            [plain["convergence"][key] for key in ("error_asked", "paths_least", "paths_most")],
            [0, 1024, 1024],
        )


class Import(FarmTest):
    def test_references_are_found_as_their_table_says(self):
        with open(
            os.path.join(farm_fixture.SOURCE_DIR, "tests/map_files/references.json"), encoding="utf-8"
        ) as file:
            cases = json.load(file)
        daemon = self.farm.daemon()
        for n, case in enumerate(cases):
            with self.subTest(case=case):
                folder = self.farm.path(f"case{n}")
                document = os.path.join(folder, case["document"])
                data = write_map(document, case["uri"], lawn=LAWN)
                if "file" in case:
                    path = os.path.join(folder, case["file"])
                    os.makedirs(os.path.dirname(path), exist_ok=True)
                    with open(path, "wb") as file:
                        file.write(data)
                # A second document makes the folder the map's.
                other = write_map(os.path.join(folder, "other.gltf"), wall=WALL)
                done = self.farm.bake(daemon, "plan", document, other, *FEW_RAYS)
                if "file" in case:
                    self.assertEqual(done.returncode, 0, done.stderr)
                else:
                    self.assert_sentence(
                        done, case["document"] + ": buffer 0: ", case["refused"], status=INVALID
                    )

    def test_a_link_finds_its_companions_both_ways(self):
        daemon = self.farm.daemon()
        for place in ("store", "work"):
            data = write_map(self.farm.path("store/v7.gltf"), "data.bin", lawn=LAWN)
            os.makedirs(self.farm.path("work"), exist_ok=True)
            with open(self.farm.path(f"{place}/data.bin"), "wb") as file:
                file.write(data)
            link = self.farm.path("work/map.gltf")
            if not os.path.islink(link):
                os.symlink("../store/v7.gltf", link)
            done = self.farm.bake(daemon, "plan", link, *FEW_RAYS)
            self.assertEqual(done.returncode, 0, done.stderr)
            os.unlink(self.farm.path(f"{place}/data.bin"))

    def test_upper_case_endings_and_repeated_maps(self):
        daemon = self.farm.daemon()
        write_map(self.farm.path("world/WEST.GLTF"), lawn=LAWN)
        east = write_map(self.farm.path("world/east.gltf"), lawn=[(x + 64, y, z) for x, y, z in LAWN])
        done = self.farm.bake(daemon, "plan", self.farm.path("world"), *FEW_RAYS)
        self.assertIn("2 sectors", done.stdout)
        done = self.farm.bake(daemon, "plan", self.farm.path("world"), east, *FEW_RAYS)
        self.assertIn("2 sectors", done.stdout)
        self.assertIn("east.gltf is named twice", done.stderr)

    def test_a_submit_first_says_what_was_understood(self):
        daemon = self.farm.daemon()
        path = with_lamps(write_map(self.farm.path("map.gltf"), lawn=LAWN, wall=WALL), 2)
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(
            done.stdout.splitlines()[:3],
            ["the map: 30 m x 30 m, 16 m high; 1 sector", "  2 static objects, 4 triangles", "  2 lamps"],
        )
        done = self.farm.bake(daemon, "--json", "plan", path, *FEW_RAYS)
        told = json.loads(done.stdout.splitlines()[0])
        self.assertEqual(
            (told["kind"], told["sectors"], told["low"], told["high"], told["lamps"], told["suns"]),
            ("map", 1, [1, 1, 0], [31, 31, 16], 2, 0),
        )

    def test_ground_that_faces_down_and_open_volumes_are_refused_with_a_remedy(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), terrain=LAWN[::-1])
        self.assert_sentence(
            self.farm.bake(daemon, "submit", path),
            "no surface of the map faces up",
            "is it on its side, or inside out?",
            status=INVALID,
        )
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN, hall=WALL)
        change(path, lambda document: document["nodes"][1].update(extras={"bake_role": "interior"}))
        self.assert_sentence(
            self.farm.bake(daemon, "submit", path),
            "map.gltf: node 1 ('hall'): its mesh, of the bake_role 'interior', is open",
            "close its holes",
            status=INVALID,
        )
        self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 1)

    def test_roles_can_stand_in_a_file_beside_the_map(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map/map.gltf"), lawn=LAWN, wall=WALL)
        with open(self.farm.path("map/roles.json"), "w", encoding="utf-8") as file:
            json.dump({"w*": "vegetation", "palm": "vegetation"}, file)
        done = self.farm.bake(daemon, "plan", path, *FEW_RAYS)
        self.assertIn("1 static object, 1 of vegetation", done.stdout)
        self.assertIn("roles.json: 'palm' matches the name of no node beside it", done.stderr)
        os.unlink(self.farm.path("map/roles.json"))
        self.assertIn("2 static objects", self.farm.bake(daemon, "plan", path, *FEW_RAYS).stdout)

    def test_a_job_too_large_to_be_meant_is_asked_for(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=[(x * 120, y * 120, z) for x, y, z in LAWN])
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS)
        self.assert_sentence(done, "the job bakes 3,364 sectors", "--yes", status=USAGE)
        for answer, number in ((b"n\n", 0), (b"y\n", 1)):
            status = self.on_terminal(daemon, answer, "submit", path, *FEW_RAYS)
            self.assertEqual(status, 0 if number else USAGE)
            self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 1 + number)
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--yes")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--region", " 200, 200 ,264 ,264 ")
        self.assertEqual(done.returncode, 0, done.stderr)

    def on_terminal(self, daemon, answer, *arguments):
        """The exit status of bake on a terminal where somebody types the answer."""
        master, slave = pty.openpty()
        try:
            process = subprocess.Popen(
                [os.path.join(OPTIONS.bin, "bake"), "--server", daemon.address, *arguments],
                stdin=slave,
                stdout=subprocess.DEVNULL,
                stderr=slave,
            )
            seen = b""
            while b"go on? [y/N]" not in seen:
                seen += os.read(master, 4096)
            os.write(master, answer)
            return process.wait(timeout=60)
        finally:
            os.close(master)
            os.close(slave)

    def test_contradictions_on_the_command_line_are_told(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        done = self.farm.bake(daemon, "plan", path, *FEW_RAYS, "--set", "rays=32")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("rays is set twice; the last one counts: rays=32", done.stderr)
        done = self.farm.bake(daemon, "plan", path, "--exact", "--set", "tolerance=0.01")
        self.assert_sentence(done, "--exact", "tolerance", status=USAGE)
        done = self.farm.bake(daemon, "plan", path, "--exact", "--set", "tolerance=0")
        self.assertEqual(done.returncode, 0, done.stderr)


class Determinism(FarmTest):
    def test_threads_daemons_and_sector_order_do_not_matter(self):
        island = self.island()
        one = self.farm.daemon("one", "--threads", "1")
        whole = self.pulled(one, island, *REGION, *FEW_RAYS, name="whole")
        two = self.farm.daemon("two", "--threads", "2")
        # The same sectors in another order: first some strips from the north, then all.
        for y in (100, -60, 20):
            strip = self.farm.bake(
                two, "submit", island, "--region", f"-130,{y},250,{y}", *FEW_RAYS, "--wait"
            )
            self.assertEqual(strip.returncode, 0, strip.stderr)
        parts = self.pulled(two, island, *REGION, *FEW_RAYS, name="parts")
        self.assertEqual(sorted(whole), sorted(parts))
        self.assertEqual([name for name in whole if whole[name] != parts[name]], [])

    def test_what_lies_beyond_the_reach_changes_no_byte(self):
        island = self.island()
        daemon = self.farm.daemon()
        near = ["--region", "0,0,60,60", *FEW_RAYS, "--set", "reach=100"]
        before = self.pulled(daemon, island, *near, name="before")
        with open(island, encoding="utf-8") as file:
            document = json.load(file)
        rock = next(n for n in document["nodes"] if "mesh" in n and n.get("name", "").startswith("rock"))
        document["nodes"].append({"mesh": rock["mesh"], "translation": [400.0, 60.0, 0.0]})
        document["scenes"][document.get("scene", 0)]["nodes"].append(len(document["nodes"]) - 1)
        with open(island, "w", encoding="utf-8") as file:
            json.dump(document, file)
        after = self.pulled(daemon, island, *near, name="after")
        self.assertEqual(before, after)


class Crashes(FarmTest):
    def test_killed_workers_and_daemon_lose_nothing(self):
        island = self.island()
        calm = self.farm.daemon("calm")
        expected = self.pulled(calm, island, *REGION, *FEW_RAYS, name="expected")
        daemon = self.farm.daemon("stormy")
        submitted = last_object(self.farm.bake(daemon, "--json", "submit", island, *REGION, *FEW_RAYS))
        self.assertIn(submitted["state"], ("waiting", "running"))

        def done():
            return self.farm.job(daemon, 1)["sectors_done"]

        wait_until(lambda: done() >= 2, what="the first sectors")
        first_worker = daemon.worker_pid()
        os.kill(first_worker, signal.SIGKILL)
        wait_until(lambda: daemon.worker_pid() != first_worker, what="a new worker")
        wait_until(lambda: done() >= 5, what="sectors after the worker's death")
        worker = daemon.worker_pid()
        daemon.kill()
        wait_until(lambda: has_ended(worker), what="the worker's end with its daemon")
        daemon.start()
        watched = self.farm.bake(daemon, "watch", "1")
        self.assertEqual(watched.returncode, 0, watched.stderr)
        pulled = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("stormy_files"))
        self.assertEqual(pulled.returncode, 0, pulled.stderr)
        self.assertEqual(expected, read_folder(self.farm.path("stormy_files")))

    def test_client_follows_its_job_through_a_restart(self):
        island = self.island()
        daemon = self.farm.daemon()
        client = self.farm.start_bake(daemon, "submit", island, *REGION, *FEW_RAYS, "--wait")
        wait_until(
            lambda: "job 1:" in daemon.log() and self.farm.job(daemon, 1)["sectors_done"] >= 1,
            what="the first sector",
        )
        daemon.kill()
        time.sleep(0.3)
        daemon.start()
        out, err = client.communicate(timeout=120)
        self.assertEqual(client.returncode, 0, err)
        self.assertIn("succeeded: 35 of 35", out)

    def test_damaged_result_is_baked_again(self):
        island = self.island(100)
        daemon = self.farm.daemon()
        region = ["--region", "0,0,65,65", *FEW_RAYS]
        first = self.pulled(daemon, island, *region, name="first")
        self.assertEqual(len(first), 4)

        def damage(name):
            digest = hashlib.sha256(first[name]).hexdigest()
            with open(self.farm.path(f"data/blobs/objects/{digest[:2]}/{digest}"), "r+b") as blob:
                blob.seek(100)
                blob.write(b"\xff\xff")

        damage("sector_0_0.drtv")
        damage("sector_1_0.drtv")
        refused = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("second"))
        self.assert_sentence(refused, "damaged", "and 1 more", "submit the map again")
        self.assertEqual(
            read_folder(self.farm.path("second")),
            {name: first[name] for name in ("sector_0_1.drtv", "sector_1_1.drtv")},
        )
        self.assertEqual(self.pulled(daemon, island, *region, name="third"), first)
        # One that nobody has pulled since: the submit finds it, tells it and bakes it anew.
        damage("sector_0_1.drtv")
        again = self.farm.bake(daemon, "submit", island, *region, "--pull", self.farm.path("fourth"))
        self.assertIn("sector (0, 1): an earlier result cannot be used", again.stderr)
        self.assertIn("3 of them from the cache", again.stdout)
        self.assertEqual(read_folder(self.farm.path("fourth")), first)


class Database(FarmTest):
    """What the database does not take is not done; what it says is checked."""

    def change(self, sql):
        with sqlite3.connect(self.farm.path("data/farm.sqlite")) as other:
            self.assertGreater(other.execute(sql).rowcount, 0, sql)
        other.close()

    def test_a_database_that_is_locked_for_longer_than_anyone_waits_costs_time_alone(self):
        daemon = self.farm.daemon()
        island = self.island(100)
        submitted = self.farm.start_bake(
            daemon, "submit", island, *REGION, *FEW_RAYS, "--pull", self.farm.path("out")
        )
        wait_until(lambda: "job 1: " in daemon.log(), what="the job")
        wait_until(lambda: self.farm.job(daemon, 1)["sectors_done"] > 3, what="some sectors")
        other = sqlite3.connect(self.farm.path("data/farm.sqlite"), isolation_level=None)
        other.execute("BEGIN EXCLUSIVE")
        time.sleep(7)
        during = self.farm.job(daemon, 1)
        self.assertIn(during["state"], ("waiting", "running"))
        other.execute("ROLLBACK")
        other.close()
        self.assertEqual(submitted.wait(timeout=300), 0)
        after = self.farm.job(daemon, 1)
        self.assertEqual((after["state"], after["sectors_done"]), ("succeeded", 35))
        self.assertEqual(len(read_folder(self.farm.path("out"))), 35)

    def test_damaged_rows_are_misses_and_are_told(self):
        daemon = self.farm.daemon()
        island = self.island(100)
        region = ["--region", "0,0,65,65", *FEW_RAYS]
        first = self.pulled(daemon, island, *region, name="first")
        daemon.stop()
        # One character of the settings of a job that goes on, and the file of a result.
        self.change("UPDATE job SET state = 0, setting_bounces = setting_bounces + 1")
        self.change(
            "UPDATE result SET file = (SELECT file FROM result WHERE i = 1 AND j = 1) WHERE i = 0 AND j = 0"
        )
        daemon.start()
        job = self.farm.job(daemon, 1)
        self.assertEqual(job["state"], "failed")
        self.assertIn("its row in the database is damaged", job["error"])
        again = self.farm.bake(daemon, "submit", island, *region, "--pull", self.farm.path("second"))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("sector (0, 0): the row of an earlier result is damaged", again.stderr)
        self.assertIn("3 of them from the cache", again.stdout)
        self.assertEqual(read_folder(self.farm.path("second")), first)

    def test_a_damaged_file_is_refused_with_a_remedy(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.island(100), "--region", "0,0,65,65", *FEW_RAYS)
        daemon.stop()
        path = self.farm.path("data/farm.sqlite")
        with open(path, "r+b") as file:
            for page in range(1, os.path.getsize(path) // 4096):
                file.seek(page * 4096)
                file.write(b"\x5a" * 600)
        with self.assertRaisesRegex(
            AssertionError, "is damaged .*: move it away, and start again without its jobs"
        ):
            daemon.start()
        os.remove(path)
        daemon.start()
        self.assertEqual(self.farm.bake(daemon, "list").returncode, 0)


class Client(FarmTest):
    def test_wrong_requests_get_one_sentence_each(self):
        daemon = self.farm.daemon()
        island = self.island(10)
        empty = self.farm.path("empty")
        os.mkdir(empty)
        cases = [
            (UNREADABLE, ["submit", "/nowhere/map.glb"], ["/nowhere/map.glb", "does not exist"]),
            (UNREADABLE, ["submit", empty], ["holds no .glb or .gltf file"]),
            (UNREADABLE, ["submit", "/dev/zero"], ["/dev/zero", "not a regular file"]),
            (UNREADABLE, ["submit", island, "--pull", island], ["cannot make the folder"]),
            (USAGE, ["submit"], ["MAP"]),
            (USAGE, ["sumbit", island], ["sumbit"]),
            (USAGE, ["submit", island, "--preset", "ultra"], ['there is no preset "ultra"']),
            (USAGE, ["submit", island, "--set", "rays=none"], ["rays", "'none'"]),
            (USAGE, ["submit", island, "--set", "rays=8"], ["16 to 65536"]),
            (USAGE, ["submit", island, "--set", "shadows=1"], ['"shadows"']),
            (USAGE, ["submit", island, "--set", "rays"], ["key=value"]),
            (USAGE, ["submit", island, "--region", "1,2,3"], ["X0,Y0,X1,Y1"]),
            (USAGE, ["submit", island, "--region", "9,0,1,1"], ["is empty"]),
            (USAGE, ["submit", island, "--region", "nan,0,1,1"], ["not a number of metres"]),
            (USAGE, ["submit", island, "--region", "9000,9000,9001,9001"], ["touches no sector with ground"]),
            (USAGE, ["status", "7"], ["there is no job 7"]),
            (USAGE, ["watch", "seven"], ['"seven" is no number of a job']),
            (USAGE, ["cancel", "7"], ["there is no job 7"]),
            (USAGE, ["pull", "7", "--out", self.farm.path("out")], ["there is no job 7"]),
        ]
        for status, arguments, parts in cases:
            with self.subTest(arguments=arguments):
                self.assert_sentence(self.farm.bake(daemon, *arguments), *parts, status=status)
        self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 1)

    def test_absent_daemon_is_told(self):
        self.assert_sentence(
            self.farm.run("bake", "--server", "127.0.0.1:1", "list"),
            "cannot reach bakerd at 127.0.0.1:1",
            status=SERVER,
        )

    def test_interrupted_client_leaves_the_job_running(self):
        daemon = self.farm.daemon()
        client = self.farm.start_bake(daemon, "submit", self.island(), *REGION, *FEW_RAYS, "--wait")
        wait_until(lambda: "job 1:" in daemon.log(), what="the job")
        time.sleep(0.2)
        client.send_signal(signal.SIGINT)
        _, err = client.communicate(timeout=20)
        self.assertEqual(client.returncode, 130, err)
        self.assertIn("come back with: bake watch 1", err)
        watched = self.farm.bake(daemon, "watch", "1")
        self.assertEqual(watched.returncode, 0, watched.stderr)
        self.assertIn("job 1 succeeded", watched.stdout)

    def test_cancelled_job_ends_and_keeps_what_is_done(self):
        daemon = self.farm.daemon()
        self.farm.bake(daemon, "submit", self.island(), *REGION, "--set", "rays=1024")
        wait_until(lambda: self.farm.job(daemon, 1)["sectors_done"] >= 1, what="the first sector")
        self.assertEqual(self.farm.bake(daemon, "cancel", "1").returncode, 0)
        job = self.farm.job(daemon, 1)
        self.assertEqual(job["state"], "cancelled")
        self.assertLess(job["sectors_done"], job["sectors_total"])
        pulled = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("some"))
        self.assert_sentence(pulled, "job 1 was cancelled: ", status=UNFINISHED)
        self.assertGreaterEqual(len(os.listdir(self.farm.path("some"))), 1)
        self.assert_sentence(self.farm.bake(daemon, "watch", "1"), "job 1 was cancelled: ", status=UNFINISHED)

    def test_a_job_that_is_not_over_is_no_success(self):
        daemon = self.farm.daemon()
        submitted = self.farm.bake(
            daemon, "submit", self.island(), *REGION, "--set", "rays=65536", "--wait", "--timeout", "0.5"
        )
        self.assert_sentence(
            submitted,
            "the time is over: job 1 goes on; come back with: bake watch 1",
            status=TIMEOUT,
        )
        watched = self.farm.bake(daemon, "--json", "watch", "1", "--timeout", "0.5")
        self.assertEqual(watched.returncode, TIMEOUT, watched.stderr)
        pulled = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("some"))
        self.assert_sentence(pulled, "job 1 is not finished: ", status=UNFINISHED)
        self.assertIn(self.farm.job(daemon, 1)["state"], ("waiting", "running"))

    def test_a_failed_job_is_no_success_and_what_is_done_is_pulled(self):
        daemon = self.farm.daemon()
        path = with_lamps(
            write_map(self.farm.path("lamps.gltf"), lawn=LAWN, far=[(x + 130, y, z) for x, y, z in LAWN]),
            groups=9,
        )
        out = self.farm.path("out")
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--set", "reach=8", "--pull", out)
        self.assert_sentence(done, "sectors failed; sector (0, 0)", "light groups", status=JOB_FAILED)
        self.assertEqual(list(read_folder(out)), ["sector_2_0.drtv"])
        self.assertEqual(self.farm.bake(daemon, "watch", "1").returncode, JOB_FAILED)
        self.assertEqual(self.farm.bake(daemon, "pull", "1", "--out", out).returncode, JOB_FAILED)

    def test_a_map_without_ground_is_no_success(self):
        daemon = self.farm.daemon()
        path = self.farm.path("empty.gltf")
        with open(path, "w", encoding="utf-8") as file:
            file.write('{"asset": {"version": "2.0"}}')
        self.assert_sentence(
            self.farm.bake(daemon, "submit", path, "--wait"),
            "the map has no ground, so there is nothing to bake",
            status=INVALID,
        )

    def test_json_is_one_object_a_line(self):
        daemon = self.farm.daemon()
        done = self.farm.bake(
            daemon,
            "--json",
            "submit",
            self.island(10),
            "--region",
            "0,0,1,1",
            *FEW_RAYS,
            "--pull",
            self.farm.path("out"),
        )
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([line["kind"] for line in (lines[0], lines[-2], lines[-1])], ["map", "pull", "job"])
        self.assertEqual(lines[-2]["pulled"], 1)
        self.assertEqual(lines[-1]["state"], "succeeded")
        self.assertEqual(json.loads(self.farm.bake(daemon, "--json", "list").stdout)["job"], "1")

    def test_pull_mends_what_is_missing_or_wrong(self):
        daemon = self.farm.daemon()
        files = self.pulled(daemon, self.island(10), "--region", "0,0,100,1", *FEW_RAYS)
        names = sorted(files)
        os.remove(os.path.join(self.farm.path("pulled"), names[0]))
        with open(os.path.join(self.farm.path("pulled"), names[1]), "ab") as file:
            file.write(b"x")
        again = json.loads(
            self.farm.bake(daemon, "--json", "pull", "1", "--out", self.farm.path("pulled")).stdout
        )
        self.assertEqual((again["pulled"], again["unchanged"]), (2, len(names) - 2))
        self.assertEqual(read_folder(self.farm.path("pulled")), files)

    @unittest.skipUnless(os.geteuid() == 0, "needs root to make a small disk")
    def test_full_disk_of_the_client_is_told_and_leaves_no_half_file(self):
        daemon = self.farm.daemon()
        island = self.island(10)
        disk = self.farm.path("disk")
        with tiny_disk(disk, 65536):
            done = self.farm.bake(
                daemon, "submit", island, "--region", "0,0,400,1", *FEW_RAYS, "--pull", disk
            )
            self.assertEqual(done.returncode, UNREADABLE, done.stdout)
            self.assertIn("No space left on device", done.stderr)
            for name in os.listdir(disk):
                self.assertTrue(name.endswith(".drtv") or name == "sectors.json", name)
            for name in read_folder(disk):
                self.assertEqual(self.farm.run("drtv", "validate", os.path.join(disk, name)).returncode, 0)


class Verdicts(FarmTest):
    """What a script can trust."""

    def test_a_map_without_a_probe_is_no_success(self):
        daemon = self.farm.daemon()
        low_roof = [(x, y, 1) for x, y, z in LAWN[::-1]]
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN, roof=low_roof)
        out = self.farm.path("out")
        for command in (
            ("submit", path, *FEW_RAYS, "--pull", out),
            ("watch", "1"),
            ("pull", "1", "--out", out),
        ):
            done = self.farm.bake(daemon, *command)
            self.assert_sentence(done, "no probe was placed", "inside out?", status=INVALID)

    def test_warnings_are_errors_where_that_is_asked_for(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        strict = ("--warnings-as-errors", "submit", path, *FEW_RAYS, "--wait")
        self.assertEqual(self.farm.bake(daemon, *strict).returncode, 0)
        done = self.farm.bake(daemon, *strict, "--set", "rays=32")
        self.assertEqual(done.returncode, INVALID)
        self.assertIn("1 warning, which --warnings-as-errors makes errors", done.stderr)

    def test_the_last_line_says_all(self):
        daemon = self.farm.daemon()
        wide = [(x * 400, y * 400, z) for x, y, z in LAWN]
        path = write_map(self.farm.path("map.gltf"), lawn=wide)
        submit = ("--json", "submit", path, *FEW_RAYS, "--region", "450,450,500,500", "--pull")
        for name, baked in (("first", 1), ("second", 0)):
            done = self.farm.bake(daemon, *submit, self.farm.path(name))
            self.assertEqual(done.returncode, 0, done.stderr)
            last = last_object(done)
            self.assertEqual((last["kind"], last["state"]), ("job", "succeeded"))
            self.assertEqual(
                (last["sectors_total"], last["sectors_baked"], last["sectors_cached"]), (1, baked, 1 - baked)
            )
            self.assertEqual(len(last["warnings"]), 1)
            self.assertIn("12.0 km across", last["warnings"][0])
            self.assertGreaterEqual(last["seconds"], 0)

    def report(self, daemon, job):
        return last_object(self.farm.bake(daemon, "--json", "report", job))

    def test_a_report_says_what_the_files_say(self):
        daemon = self.farm.daemon()
        path = self.island()
        files = ("--region", "0,0,256,256", *FEW_RAYS)
        dumps = self.dumps(daemon, path, *files)
        first = self.report(daemon, "1")
        for key in ("candidates", "moved_out", "dropped_in_solid", "removed_by_volume", "thinned"):
            self.assertEqual(first["placement"][key], sum(dump["statistics"][key] for dump in dumps), key)
        placed = first["placement"]
        lost = sum(placed[key] for key in ("too_near", "dropped_in_solid", "removed_by_volume", "thinned"))
        automatic = sum(probe["kind"] != "manual" for dump in dumps for probe in dump["probes"])
        self.assertEqual(placed["candidates"] - lost, automatic)
        self.assertEqual(first["causes"][0]["cause"], "it was not baked with these settings before")
        self.assertGreater(first["stages"]["transfer"], 0)
        self.assertEqual(len(first["slowest"]), 5)
        self.assertAlmostEqual(first["slowest"][0]["seconds"], sum(first["slowest"][0]["stages"].values()))
        # All of it from the cache: it took no time, and is as it was.
        self.pulled(daemon, path, *files, name="again")
        again = self.report(daemon, "2")
        self.assertEqual((again["placement"], again["error"]), (first["placement"], first["error"]))
        self.assertEqual((again["causes"], again["slowest"], sum(again["stages"].values())), ([], [], 0))

    def test_a_report_names_what_has_changed(self):
        daemon = self.farm.daemon()
        settings = (*FEW_RAYS, "--set", "reach=32")
        self.pulled(
            daemon,
            write_map(self.farm.path("map.gltf"), lawn=LAWN, far=[(x + 128, y, z) for x, y, z in LAWN]),
            *settings,
        )
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN, far=[(x + 129, y, z) for x, y, z in LAWN])
        done = self.farm.bake(daemon, "--json", "submit", path, *settings, "--wait")
        last = last_object(done)
        self.assertEqual((last["sectors_cached"], last["sectors_baked"]), (1, 1))
        self.assertEqual(last["causes"], [{"cause": "far changed", "sectors": 1}])
        self.assertEqual(self.report(daemon, "2")["causes"], last["causes"])
        text = self.farm.bake(daemon, "report", "2").stdout
        for part in ("why", "far changed", "placement (", "places", "proposed", "slowest", "sector (2, 0)"):
            self.assertIn(part, text)

    def test_a_report_has_all_warnings_by_object(self):
        """More than the first 20: a wall that is seen from behind in each of many sectors."""
        daemon = self.farm.daemon()
        quads = {}
        for n in range(25):
            quads[f"lawn {n}"] = [(x + 64 * n, y, z) for x, y, z in LAWN]
            quads[f"wall {n}"] = [(x + 64 * n, y, z) for x, y, z in WALL[::-1]]
        path = write_map(self.farm.path("map.gltf"), **quads)
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--wait")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("5 more warnings: bake report 1", done.stderr)
        self.assertEqual(done.stderr.count("bake: warning:"), 20)
        of_sectors = self.report(daemon, "1")["warnings"]
        self.assertEqual(sum(len(entry["warnings"]) for entry in of_sectors), 25)
        last = last_object(self.farm.bake(daemon, "--json", "wait", "1"))
        self.assertEqual(len(last["warnings"]), 25)
        self.assertIn("wall 7", {entry["object"] for entry in of_sectors})
        self.assert_sentence(self.farm.bake(daemon, "report", "99"), "there is no job 99", status=USAGE)

    def test_two_settings_behind_one_option_are_told(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        done = self.farm.bake(daemon, "submit", path, "--set", "rays=16", "lprt=1")
        self.assert_sentence(done, "a setting needs a --set of its own, --set lprt=1", status=USAGE)

    def test_a_job_that_has_ended_cannot_be_cancelled(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        self.pulled(daemon, path, *FEW_RAYS)
        done = self.farm.bake(daemon, "cancel", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("had ended before: nothing was cancelled", done.stderr)

    def test_wait_says_the_end_alone(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        self.farm.bake(daemon, "submit", path, *FEW_RAYS)
        done = self.farm.bake(daemon, "wait", "1")
        self.assertEqual((done.returncode, done.stdout.count("\n")), (0, 1), done.stderr)
        done = self.farm.bake(daemon, "--json", "wait", "1")
        self.assertEqual((done.returncode, last_object(done)["state"]), (0, "succeeded"))
        self.farm.bake(daemon, "submit", self.island())
        done = self.farm.bake(daemon, "wait", "2", "--timeout", "0.3")
        self.assertEqual(done.returncode, TIMEOUT, done.stderr)

    def test_an_interactive_job_goes_before_a_nightly_one(self):
        daemon = self.farm.daemon("data", "--threads", "1")
        self.farm.bake(daemon, "submit", self.island(), "--priority", "nightly")
        self.assertEqual(self.farm.job(daemon, 1)["priority"], "nightly")
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        done = self.farm.bake(daemon, "--json", "submit", path, *FEW_RAYS, "--wait")
        self.assertEqual(last_object(done)["state"], "succeeded", done.stderr)
        self.assertEqual(last_object(done)["priority"], "interactive")
        self.assertIn(self.farm.job(daemon, 1)["state"], ("waiting", "running"))
        # Here sectors have no log of a task.
        done = self.farm.bake(daemon, "logs", "2", "0,0")
        self.assertEqual(done.returncode, USAGE)
        self.assertIn("the daemon's own log", done.stderr)
        for sector in ("0", "0,0,0", "x,y", "0, 0", "99999999999,1"):
            done = self.farm.bake(daemon, "logs", "2", sector)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (USAGE, 1), done.stderr)

    def test_jobs_are_raised_held_and_released(self):
        daemon = self.farm.daemon("data", "--threads", "1")
        nightly = ("--priority", "nightly")
        self.farm.bake(daemon, "submit", self.island(), *nightly)
        lawn = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        self.farm.bake(daemon, "submit", lawn, *FEW_RAYS, *nightly, "--label", "the lawn")
        job = self.farm.job(daemon, 2)
        self.assertEqual((job["state"], job["jobs_ahead"], job["label"]), ("waiting", 1, "the lawn"))
        told = self.farm.bake(daemon, "status", "2").stdout
        self.assertRegex(told, r'job 2 "the lawn" \(nightly\) waiting: 0 of \d+ sectors done, 1 job ahead')
        done = self.farm.bake(daemon, "raise", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.farm.bake(daemon, "wait", "2").returncode, 0)
        self.assertEqual(self.farm.job(daemon, 1)["state"], "running")
        done = self.farm.bake(daemon, "--json", "hold", "1")
        self.assertEqual(last_object(done)["state"], "held", done.stderr)
        # It stays so in the next daemon; others are baked.
        daemon.stop()
        daemon.start()
        held = self.farm.job(daemon, 1)
        self.assertEqual(held["state"], "held")
        self.assertEqual(self.farm.bake(daemon, "submit", lawn, "--set", "rays=17", "--wait").returncode, 0)
        self.assertEqual(self.farm.job(daemon, 1)["sectors_done"], held["sectors_done"])
        self.farm.bake(daemon, "release", "1")
        wait_until(
            lambda: self.farm.job(daemon, 1)["sectors_done"] > held["sectors_done"], 60, "the job to go on"
        )
        for command in ("raise", "hold", "release"):
            self.assert_sentence(self.farm.bake(daemon, command, "2"), "job 2 has ended", status=USAGE)
            self.assert_sentence(self.farm.bake(daemon, command, "9"), "there is no job 9", status=USAGE)
        self.assertIn("the lawn", self.farm.bake(daemon, "list", "--mine").stdout)
        done = self.farm.bake(daemon, "submit", lawn, "--label", "x" * 129)
        self.assert_sentence(done, "the label is longer than 128 bytes", status=USAGE)

    def test_a_giant_job_holds_up_nobody_but_its_owner(self):
        program = os.path.join(OPTIONS.bin, "bake")
        if os.getuid() != 0 or subprocess.run(["test", "-x", program], user="nobody", check=False).returncode:
            self.skipTest("this cannot be run by two people")
        daemon = self.farm.daemon("data", "--threads", "1")
        self.farm.bake(daemon, "submit", self.island())
        lawn = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        os.chmod(self.farm.scratch.name, 0o755)
        done = subprocess.run(
            [program, "--server", daemon.address, "submit", lawn, *FEW_RAYS, "--wait"],
            user="nobody",
            capture_output=True,
            text=True,
            timeout=300,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.farm.job(daemon, 1)["state"], "running")
        self.assertEqual(self.farm.job(daemon, 2)["owner"], "nobody")
        mine = self.farm.bake(daemon, "--json", "list", "--mine").stdout
        self.assertEqual([json.loads(line)["job"] for line in mine.splitlines()], ["1"])

    def test_a_job_behind_another_waits(self):
        daemon = self.farm.daemon("data", "--threads", "1")
        self.farm.bake(daemon, "submit", self.island())
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        done = self.farm.bake(daemon, "--json", "submit", path, *FEW_RAYS)
        self.assertEqual(last_object(done)["state"], "waiting")
        self.assertIn(" waiting ", self.farm.bake(daemon, "list").stdout)
        cancelled = self.farm.bake(daemon, "--json", "cancel", "1")
        self.assertEqual(self.farm.bake(daemon, "wait", "2").returncode, 0)
        # What was cancelled changes no more.
        time.sleep(0.5)
        before, after = last_object(cancelled), self.farm.job(daemon, 1)
        self.assertEqual(before["state"], "cancelled")
        self.assertEqual({**before, "warnings": []}, {**after, "warnings": []})

    def test_retry_bakes_what_failed_and_nothing_else(self):
        daemon = self.farm.daemon()
        path = with_lamps(
            write_map(self.farm.path("lamps.gltf"), lawn=LAWN, far=[(x + 130, y, z) for x, y, z in LAWN]),
            groups=9,
        )
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--set", "reach=8", "--wait")
        self.assertEqual(done.returncode, JOB_FAILED)
        retried = last_object(self.farm.bake(daemon, "--json", "retry", "1"))
        self.assertEqual((retried["sectors_done"], retried["sectors_failed"], retried["ended"]), (1, 0, 0))
        self.assertEqual(self.farm.bake(daemon, "wait", "1").returncode, JOB_FAILED)
        # It stands in the database: a restart finds it, and a cause that is gone ends well.
        job = self.farm.job(daemon, 1)
        self.assertEqual((job["state"], job["sectors_done"], job["sectors_failed"]), ("failed", 1, 1))
        daemon.stop()
        daemon.start()
        self.assertEqual(self.farm.job(daemon, 1)["sectors_failed"], 1)
        self.assertEqual(self.farm.bake(daemon, "retry", "1").returncode, 0)
        self.assertEqual(self.farm.bake(daemon, "wait", "1").returncode, JOB_FAILED)
        lawn = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        self.farm.bake(daemon, "submit", lawn, *FEW_RAYS, "--wait")
        done = self.farm.bake(daemon, "retry", "2")
        self.assert_sentence(done, "job 2 cannot be retried: no sector of it has failed", status=USAGE)
        self.assert_sentence(self.farm.bake(daemon, "retry", "7"), "there is no job 7", status=USAGE)

    def test_evicted_results_are_named_by_sector(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--wait")
        self.farm.bake(daemon, "cache", "--clear")
        done = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("out"))
        self.assert_sentence(
            done,
            "the file of sector (0, 0) is no longer kept; submit the map again to bake it again",
            status=UNREADABLE,
        )
        self.assertNotIn(self.farm.scratch.name + "/data", done.stderr)


class Pull(FarmTest):
    """Folders that are whole."""

    def test_lost_files_of_a_large_map_cost_no_other(self):
        daemon = self.farm.daemon()
        side = 46 * 64 - 1  # 2,116 sectors: the client lists them in two pages
        plain = write_map(
            self.farm.path("plain.gltf"), plain=[(1, 1, 0), (side, 1, 0), (side, side, 0), (1, side, 0)]
        )
        few = ["--set", "rays=16", "--set", "bounces=1", "--set", "reach=16"]
        done = self.farm.bake(daemon, "submit", plain, "--preset", "draft", *few, "--wait", "--yes")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("all")).returncode, 0)
        everything = read_folder(self.farm.path("all"))
        self.assertEqual(len(everything), 2116)
        for name in ("sector_0_0.drtv", "sector_45_45.drtv"):
            digest = hashlib.sha256(everything.pop(name)).hexdigest()
            os.remove(self.farm.path(f"data/blobs/objects/{digest[:2]}/{digest}"))
        refused = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("rest"))
        self.assert_sentence(
            refused,
            "the file of sector (0, 0) is no longer kept",
            "(1 file of later sectors is lost too)",
            status=UNREADABLE,
        )
        self.assertTrue(read_folder(self.farm.path("rest")) == everything)
        # What it began lists them all, so that a later pull knows them as ours.
        with open(self.farm.path("rest/sectors.json"), encoding="utf-8") as file:
            begun = json.load(file)
        self.assertEqual((begun["pulling"], len(begun["sectors"])), (True, 2116))

    def two_islands(self, name="map.gltf"):
        moved = [(x + 128, y, z) for x, y, z in LAWN]
        return write_map(self.farm.path(name), lawn=LAWN, far=moved)

    def manifest(self, name="pulled"):
        with open(self.farm.path(name + "/sectors.json"), encoding="utf-8") as file:
            manifest = json.load(file)
        json_lines.validator("sectors").validate(manifest)
        return manifest

    def assert_whole(self, name="pulled"):
        """The manifest lists what is there, and drtv agrees."""
        listed = {entry["file"]: entry["sha256"] for entry in self.manifest(name)["sectors"]}
        there = read_folder(self.farm.path(name))
        self.assertEqual(listed, {file: hashlib.sha256(data).hexdigest() for file, data in there.items()})
        self.assertEqual([file for file in os.listdir(self.farm.path(name)) if ".part" in file], [])
        done = self.farm.run("drtv", "validate", self.farm.path(name))
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_manifest_says_what_the_folder_holds(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.two_islands(), *FEW_RAYS)
        manifest = self.manifest()
        self.assertEqual([entry["sector"] for entry in manifest["sectors"]], [[0, 0], [2, 0]])
        self.assertEqual(
            (manifest["documents"], manifest["job"], manifest["preset"], manifest["settings"]["rays"]),
            (["map.gltf"], "1", "draft", 64),
        )
        self.assertEqual((manifest["baker_version"], manifest["unfinished"]), (6, 0))
        self.assert_whole()

    def test_files_that_the_map_no_longer_has_are_removed_and_told(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.two_islands("before.gltf"), *FEW_RAYS)
        self.assertEqual(len(read_folder(self.farm.path("pulled"))), 2)
        # Another document, of another name: an object that both have makes them versions of one map.
        after = write_map(self.farm.path("after.gltf"), lawn=LAWN)
        done = self.farm.bake(daemon, "submit", after, *FEW_RAYS, "--pull", self.farm.path("pulled"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 removed that the map no longer has", done.stdout)
        self.assertEqual(list(read_folder(self.farm.path("pulled"))), ["sector_0_0.drtv"])
        self.assert_whole()
        # One that somebody changed stays, and is told.
        self.pulled(daemon, self.two_islands("before.gltf"), *FEW_RAYS)
        with open(self.farm.path("pulled/sector_2_0.drtv"), "ab") as file:
            file.write(b"mine")
        done = self.farm.bake(daemon, "pull", "2", "--out", self.farm.path("pulled"))
        self.assertIn("1 sector files", done.stderr)
        self.assertIn("somebody changed them", done.stderr)
        self.assertIn("sector_2_0.drtv", read_folder(self.farm.path("pulled")))
        done = self.farm.run("drtv", "validate", self.farm.path("pulled"))
        self.assertEqual(done.returncode, INVALID)
        self.assertIn("sector_2_0.drtv is not listed", done.stderr)

    def test_a_folder_of_another_map_is_refused_before_the_bake(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.two_islands("one.gltf"), *FEW_RAYS)
        before = read_folder(self.farm.path("pulled"))
        other = write_map(self.farm.path("other.gltf"), wall=WALL, floor=[(x, y, 1) for x, y, z in LAWN])
        submit = ("submit", other, *FEW_RAYS, "--pull", self.farm.path("pulled"))
        done = self.farm.bake(daemon, *submit)
        self.assert_sentence(done, "holds sectors of another map (one.gltf)", "--replace", status=INVALID)
        self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 2)
        self.assertEqual(read_folder(self.farm.path("pulled")), before)
        done = self.farm.bake(daemon, *submit, "--replace")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 removed", done.stdout)
        self.assert_whole()
        done = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("pulled"))
        self.assert_sentence(done, "holds sectors of another map (other.gltf)", status=INVALID)

    def test_a_region_leaves_the_files_around_it_and_says_of_which_map_they_are(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.two_islands(), *FEW_RAYS)
        earlier = self.manifest()["map"]
        write_map(self.farm.path("map.gltf"), lawn=LAWN, wall=WALL, far=[(x + 128, y, z) for x, y, z in LAWN])
        self.pulled(daemon, self.farm.path("map.gltf"), *FEW_RAYS, "--region", "0,0,1,1")
        near, far = self.manifest()["sectors"]
        self.assertNotEqual(self.manifest()["map"], earlier)
        self.assertEqual((near.get("map"), far.get("map")), (None, earlier))
        self.assertEqual(self.manifest()["region"], [0, 0, 1, 1])
        self.assert_whole()

    def test_validate_names_what_is_not_as_it_was_pulled(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.two_islands(), *FEW_RAYS)
        folder = self.farm.path("pulled")
        os.rename(folder + "/sector_0_0.drtv", folder + "/sector_2_0.drtv")
        done = self.farm.run("drtv", "validate", folder)
        self.assertEqual(done.returncode, INVALID)
        self.assertIn("sector_0_0.drtv is listed, and cannot be read", done.stderr)
        self.assertIn("sector_2_0.drtv", done.stderr)
        for text, sentence in (("{", "is not the manifest of a pull"), ('{"version": 99}', "a newer bake")):
            with open(folder + "/sectors.json", "w", encoding="utf-8") as file:
                file.write(text)
            done = self.farm.run("drtv", "validate", folder)
            self.assertEqual(done.returncode, INVALID)
            self.assertIn(sentence, done.stderr)
        os.unlink(folder + "/sectors.json")
        done = self.farm.bake(daemon, "pull", "1", "--out", folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_whole()

    def test_a_picture_of_another_map_is_refused(self):
        daemon = self.farm.daemon()
        path = self.two_islands()
        self.pulled(daemon, path, *FEW_RAYS)
        render = ("render", self.farm.path("pulled"), "--map", path, "--size", "32x32", "--out")
        done = self.farm.run("bakerd", *render, self.farm.path("x.png"))
        self.assertEqual(done.returncode, 0, done.stderr)
        write_map(path, lawn=LAWN, wall=WALL)
        done = self.farm.run("bakerd", *render, self.farm.path("y.png"))
        self.assert_sentence(done, "baked of another map, or before an edit", status=INVALID)

    def test_two_pulls_into_one_folder_both_succeed(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.island(), *REGION, *FEW_RAYS, name="first")
        both = [
            self.farm.start_bake(daemon, "pull", "1", "--out", self.farm.path("pulled")) for _ in range(2)
        ]
        for pull in both:
            out, err = pull.communicate(timeout=60)
            self.assertEqual(pull.returncode, 0, out + err)
        self.assertEqual(read_folder(self.farm.path("pulled")), read_folder(self.farm.path("first")))
        self.assert_whole()

    def test_a_pull_that_is_killed_goes_on(self):
        daemon = self.farm.daemon()
        expected = self.pulled(daemon, self.island(), *REGION, *FEW_RAYS, name="first")
        for delay in (0.02, 0.04, 0.06):
            pull = self.farm.start_bake(daemon, "pull", "1", "--out", self.farm.path("pulled"))
            time.sleep(delay)
            pull.kill()
            pull.communicate()
        done = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("pulled"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(read_folder(self.farm.path("pulled")), expected)

    def test_a_pull_goes_on_where_its_connection_was_cut(self):
        daemon = self.farm.daemon()
        expected = self.pulled(daemon, self.island(), *REGION, *FEW_RAYS, name="first")
        for cut_after in (20_000, 60_000, 200_000):
            with cutting_proxy(daemon.address, cut_after) as address:
                folder = self.farm.path(f"cut{cut_after}")
                done = self.farm.run("bake", "--server", address, "pull", "1", "--out", folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn("lost bakerd", done.stderr)
                self.assertEqual(read_folder(folder), expected)

    def test_a_file_removed_during_the_pull_comes_again(self):
        daemon = self.farm.daemon()
        expected = self.pulled(daemon, self.island(), *REGION, *FEW_RAYS, name="first")
        folder = self.farm.path("second")
        with cutting_proxy(daemon.address, 400_000) as address:
            bake = subprocess.Popen(
                [os.path.join(OPTIONS.bin, "bake"), "--server", address, "pull", "1", "--out", folder],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            # Its line breaks after some files, and it waits a moment.
            self.assertIn("lost bakerd", bake.stderr.readline())
            os.unlink(os.path.join(folder, sorted(read_folder(folder))[0]))
            out, err = bake.communicate(timeout=60)
        self.assertEqual(bake.returncode, 0, out + err)
        self.assertTrue(read_folder(folder) == expected)

    def test_a_pull_that_fails_leaves_no_folder_of_its_own(self):
        daemon = self.farm.daemon()
        made, known, link = self.farm.path("made"), self.farm.path("known"), self.farm.path("link")
        os.mkdir(known)
        os.symlink(self.farm.path("away/folder"), link)
        for folder in (made, known):
            done = self.farm.bake(daemon, "pull", "7", "--out", folder)
            self.assert_sentence(done, "there is no job 7", status=USAGE)
        self.assertEqual((os.path.exists(made), os.path.exists(known)), (False, True))
        self.assertNotEqual(self.farm.bake(daemon, "pull", "7", "--out", link).returncode, 0)
        self.assertTrue(os.path.islink(link))

    def test_a_pull_that_cannot_write_ends(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.island(), *REGION, *FEW_RAYS, name="first")
        for n in range(4):
            folder = self.farm.path(f"blocked{n}")
            for name in list(read_folder(self.farm.path("first")))[:2]:
                os.makedirs(os.path.join(folder, name, "x"))
            done = self.farm.bake(daemon, "pull", "1", "--out", folder, timeout=60)
            self.assert_sentence(done, "cannot write", "sector_", status=UNREADABLE)
            # What it began is told.
            self.assertTrue(json.load(open(folder + "/sectors.json", encoding="utf-8"))["pulling"])

    def test_pulls_of_two_regions_into_one_folder_list_each_other(self):
        daemon = self.farm.daemon()
        island = self.island()
        west, east = ["--region", "-130,-60,-1,60"], ["--region", "1,-60,130,60"]
        self.pulled(daemon, island, *east, *FEW_RAYS, name="east")
        slow = self.farm.start_bake(
            daemon, "submit", island, *west, *FEW_RAYS, "--pull", self.farm.path("pulled")
        )
        wait_until(lambda: os.path.exists(self.farm.path("pulled/sectors.json")), what="the first pull")
        done = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("pulled"))
        self.assertEqual(done.returncode, 0, done.stderr)
        out, err = slow.communicate(timeout=120)
        self.assertEqual(slow.returncode, 0, out + err)
        self.assert_whole()

    def test_files_of_no_pull_are_told(self):
        daemon = self.farm.daemon()
        path = self.two_islands()
        os.mkdir(self.farm.path("pulled"))
        for name in ("sector_7_7.drtv", "sector_8_8.drtv"):
            with open(self.farm.path("pulled/" + name), "wb") as file:
                file.write(b"old")
        done = self.farm.bake(daemon, "submit", path, *FEW_RAYS, "--pull", self.farm.path("pulled"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 sector files are in", done.stderr)
        self.assertIn("the first sector_7_7.drtv", done.stderr)
        done = self.farm.bake(daemon, "--warnings-as-errors", "pull", "1", "--out", self.farm.path("pulled"))
        self.assertEqual(done.returncode, INVALID, done.stderr)

    def test_a_folder_says_whether_it_is_whole(self):
        daemon = self.farm.daemon()
        folder = self.farm.path("pulled")
        self.pulled(daemon, self.two_islands(), *FEW_RAYS)
        validate = ("drtv", "validate", folder, "--json")

        def state(*more):
            done = self.farm.run(*validate, *more)
            (told,) = json.loads(done.stdout)["folders"]
            self.assertEqual(told["folder"], folder)
            return told["state"], done.returncode

        self.assertEqual((state(), state("--whole")), (("whole", 0), ("whole", 0)))
        with open(folder + "/sectors.json", encoding="utf-8") as file:
            manifest = file.read()

        def rewrite(text):
            with open(folder + "/sectors.json", "w", encoding="utf-8") as out:
                out.write(text)

        rewrite(manifest.replace('"unfinished": 0', '"unfinished": 3'))
        self.assertEqual((state(), state("--whole")), (("unfinished", 0), ("unfinished", INVALID)))
        self.assertEqual(state("--warnings-as-errors"), ("unfinished", INVALID))
        rewrite(manifest.replace('"unfinished": 0', '"unfinished": 0, "pulling": true'))
        self.assertEqual((state(), state("--quick")), (("pulling", INVALID), ("pulling", INVALID)))
        for command in (["info", folder], ["preview", folder, "--out", self.farm.path("p.png")]):
            done = self.farm.run("drtv", *command)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("a pull into", done.stderr)
        os.unlink(folder + "/sectors.json")
        self.assertEqual((state(), state("--whole")), (("no manifest", 0), ("no manifest", INVALID)))
        rewrite(manifest)
        os.unlink(folder + "/sector_2_0.drtv")
        self.assertEqual((state(), state("--quick")), (("wrong", INVALID), ("wrong", INVALID)))

    def test_a_folder_in_place_of_a_file_is_a_sentence(self):
        daemon = self.farm.daemon()
        self.pulled(daemon, self.two_islands(), *FEW_RAYS)
        os.unlink(self.farm.path("pulled/sectors.json"))
        os.mkdir(self.farm.path("pulled/sectors.json"))
        done = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("pulled"))
        self.assert_sentence(done, "sectors.json: it is a folder", status=UNREADABLE)
        done = self.farm.bake(daemon, "--tls-ca", "/etc", "--tls-cert", "/etc", "--tls-key", "/etc", "list")
        self.assert_sentence(done, "cannot read /etc: it is a folder", status=UNREADABLE)

    def test_the_folder_is_tried_before_the_bake(self):
        daemon = self.farm.daemon()
        path = self.two_islands()
        for folder in ("/proc/none", path):
            done = self.farm.bake(daemon, "submit", path, "--pull", folder)
            self.assert_sentence(done, folder, status=UNREADABLE)
        self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 1)


class LettingGo(FarmTest):
    """The client that leaves, waits, or is left alone."""

    def interrupt(self, process, patience_s=5):
        """Ctrl-C; gives what it said. It ends within the time."""
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=patience_s)
        self.assertEqual(process.returncode, 130, out + err)
        return err

    def test_ctrl_c_ends_an_import_and_no_job_is_made(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        with_many_instances(path, 1_500_000)
        submit = self.farm.start_bake(daemon, "submit", path, *FEW_RAYS)
        wait_until(daemon.worker_pid, what="the import")
        time.sleep(0.5)
        self.assertIn("interrupted", self.interrupt(submit))
        wait_until(
            lambda: self.farm.bake(daemon, "plan", write_map(self.farm.path("b.gltf"), lawn=LAWN)).returncode
            == 0
        )
        self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 1)

    def test_ctrl_c_ends_calls_and_uploads_to_a_daemon_that_stands_still(self):
        daemon = self.farm.daemon()
        path = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        job = self.pulled(daemon, path, *FEW_RAYS) and "1"
        daemon.process.send_signal(signal.SIGSTOP)
        try:
            for arguments in (
                ("submit", path),
                ("status", job),
                ("list",),
                ("watch", job),
                ("pull", job, "--out", self.farm.path("other")),
            ):
                bake = self.farm.start_bake(daemon, *arguments)
                time.sleep(0.4)
                self.interrupt(bake)
        finally:
            daemon.process.send_signal(signal.SIGCONT)

    def test_ctrl_c_ends_an_upload_that_stands_still(self):
        daemon = self.farm.daemon()
        path = lawn_with_ballast(self.farm.path("map.gltf"), 96 << 20)
        with cutting_proxy(daemon.address, None, stall_after=3_000_000) as address:
            bake = subprocess.Popen(
                [os.path.join(OPTIONS.bin, "bake"), "--server", address, "submit", path],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            time.sleep(1.5)
            self.assertIn("what was uploaded stays with the server", self.interrupt(bake))

    def test_a_second_client_with_the_same_file_takes_part(self):
        daemon = self.farm.daemon()
        path = lawn_with_ballast(self.farm.path("map.gltf"), 48 << 20)
        both = [self.farm.start_bake(daemon, "plan", path, *FEW_RAYS) for _ in range(2)]
        for plan in both:
            out, err = plan.communicate(timeout=120)
            self.assertEqual(plan.returncode, 0, out + err)

    def test_a_watch_of_a_dead_connection_ends(self):
        daemon = self.farm.daemon()
        self.assertEqual(self.farm.bake(daemon, "submit", self.island()).returncode, 0)
        watch = self.farm.start_bake(daemon, "watch", "1", "--timeout", "3")
        time.sleep(0.5)
        daemon.process.send_signal(signal.SIGSTOP)
        try:
            out, err = watch.communicate(timeout=10)
            self.assertEqual(watch.returncode, TIMEOUT, out + err)
        finally:
            daemon.process.send_signal(signal.SIGCONT)

    def test_the_time_is_kept_by_a_daemon_that_stands_still_or_is_gone(self):
        daemon = self.farm.daemon()
        self.assertEqual(self.farm.bake(daemon, "submit", self.island()).returncode, 0)
        daemon.process.send_signal(signal.SIGSTOP)
        try:
            begin = time.monotonic()
            done = self.farm.bake(daemon, "wait", "1", "--timeout", "1")
            self.assert_sentence(done, "the time is over, and bakerd at", "had not answered", status=TIMEOUT)
            self.assertLess(time.monotonic() - begin, 5)
        finally:
            daemon.process.send_signal(signal.SIGCONT)
        pull = ("submit", self.island(), "--pull", self.farm.path("pulled"), "--timeout", "4")
        submit = self.farm.start_bake(daemon, *pull)
        wait_until(lambda: os.path.exists(self.farm.path("pulled/sectors.json")), what="the pull")
        begin = time.monotonic()
        daemon.process.kill()
        out, err = submit.communicate(timeout=30)
        self.assertEqual(submit.returncode, TIMEOUT, out + err)
        self.assertIn("is away", err)
        self.assertLess(time.monotonic() - begin, 20)

    def test_what_stands_in_the_way_to_the_daemon_is_told(self):
        daemon = self.farm.daemon()
        key, certificate = self.farm.path("key.pem"), self.farm.path("cert.pem")
        curve = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
        subprocess.run(
            ["openssl", "req", "-x509", *curve, "-subj", "/CN=x", "-keyout", key, "-out", certificate],
            check=True,
            capture_output=True,
        )
        secured = ("--tls-ca", certificate, "--tls-cert", certificate, "--tls-key", key)
        self.assert_sentence(
            self.farm.bake(daemon, *secured, "list"), "the TLS handshake failed", status=SERVER
        )
        done = self.farm.bake(daemon, *secured[:-1], __file__, "list")
        self.assert_sentence(done, __file__, "is no PEM file", status=INVALID)
        for server, status, words in (
            ("http://127.0.0.1:7447", USAGE, "is not HOST:PORT"),
            ("127.0.0.1:99999", USAGE, "a port from 1 to 65535"),
            ("127.0.0.1:1", SERVER, "is it running?"),
            ("nowhere.invalid:7447", SERVER, "there is no such host"),
        ):
            done = self.farm.run("bake", "--server", server, "list", timeout=60)
            self.assert_sentence(done, server, words, status=status)

    def test_loopback_never_goes_through_a_proxy(self):
        daemon = self.farm.daemon()
        proxy = {
            "http_proxy": "http://127.0.0.1:1",
            "https_proxy": "http://127.0.0.1:1",
            "grpc_proxy": "http://127.0.0.1:1",
        }
        for address in (daemon.address, daemon.address.replace("127.0.0.1", "localhost")):
            done = self.farm.run("bake", "--server", address, "list", env=proxy, timeout=20)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_servers_have_names_and_options_count_before_environment_and_file(self):
        daemon = self.farm.daemon()
        path = self.farm.path("bake.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(
                f'server = "here"\n[here]\naddress = "{daemon.address}"\n[gone]\naddress = "127.0.0.1:1"\n'
            )
        file = {"DRTV_CONFIG": path}
        self.assertEqual(self.farm.run("bake", "list", env=file).returncode, 0)
        self.assertEqual(self.farm.run("bake", "--server", "gone", "list", env=file).returncode, SERVER)
        gone = {**file, "DRTV_SERVER": "gone"}
        self.assertEqual(self.farm.run("bake", "list", env=gone).returncode, SERVER)
        self.assertEqual(self.farm.run("bake", "--server", "here", "list", env=gone).returncode, 0)
        done = self.farm.run("bake", "--server", "hero", "list", env=file)
        self.assert_sentence(done, "neither HOST:PORT nor a name", 'Did you mean "here"?', status=USAGE)
        done = self.farm.run("bake", "list", env={**file, "DRTV_TLS_CA": "/nowhere/ca.pem"})
        self.assert_sentence(done, "cannot read /nowhere/ca.pem", status=UNREADABLE)
        with open(path, "a", encoding="utf-8") as file:
            file.write('colour = "red"\n')
        done = self.farm.run("bake", "list", env={"DRTV_CONFIG": path})
        self.assert_sentence(done, "bake.toml: 'gone.colour' is not known there", status=USAGE)

    def test_versions_further_apart_are_told(self):
        for version, works in (("0.2.7", True), ("0.3.0", False), ("1.1.0", False), ("", False)):
            with version_server(version) as address:
                done = self.farm.run("bake", "--server", address, "list")
                if works:
                    self.assertNotIn("minor version apart", done.stderr)
                else:
                    self.assert_sentence(
                        done, version or "0.1.0 or older", "0.1.0", "minor version apart", status=SERVER
                    )


class Daemon(FarmTest):
    def test_taken_port_taken_folder_and_unwritable_folder_are_told(self):
        daemon = self.farm.daemon()
        port = self.farm.run(
            "bakerd", "serve", "--data", self.farm.path("other"), "--listen", daemon.address, timeout=20
        )
        self.assert_sentence(
            port, f"cannot listen on {daemon.address}: the port is in use", status=UNREADABLE
        )
        folder = self.farm.run(
            "bakerd", "serve", "--data", self.farm.path("data"), "--listen", "127.0.0.1:0", timeout=20
        )
        self.assert_sentence(folder, "in use by another bakerd", str(daemon.process.pid), status=UNREADABLE)
        unwritable = self.farm.run(
            "bakerd", "serve", "--data", "/proc/drtv", "--listen", "127.0.0.1:0", timeout=20
        )
        self.assert_sentence(unwritable, "/proc/drtv", status=UNREADABLE)
        no_port = self.farm.run(
            "bakerd", "serve", "--data", self.farm.path("x"), "--listen", "127.0.0.1:99999", timeout=20
        )
        self.assert_sentence(no_port, "127.0.0.1:99999", status=UNREADABLE)

    def test_a_map_too_large_for_the_worker_fails_in_a_sentence(self):
        daemon = self.farm.daemon("data", "--worker-memory", "256MB")
        large = write_map(self.farm.path("large.gltf"), lawn=LAWN)
        with_many_instances(large, 1_500_000)
        done = self.farm.bake(daemon, "submit", large, *FEW_RAYS)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("more memory than its limit of 256 MB", done.stderr)
        lawn = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        done = self.farm.bake(daemon, "submit", lawn, *FEW_RAYS, "--wait")
        self.assertEqual(done.returncode, 0, done.stderr + daemon.log())
        nice = subprocess.run(
            ["ps", "-o", "ni=", "-p", str(daemon.worker_pid())], capture_output=True, text=True, check=True
        )
        self.assertEqual(nice.stdout.strip(), "10")

    def test_wrong_arguments_are_told(self):
        for arguments, part in (
            (["serve"], "--data"),
            (["serve", "--data", "x", "--executor", "cloud"], "cloud"),
            (["serve", "--data", "x", "--threads", "-1"], "-1"),
            (["fly"], '"fly"'),
            (["serve", "--config", "/nowhere.ini"], "/nowhere.ini"),
        ):
            with self.subTest(arguments=arguments):
                self.assert_sentence(
                    self.farm.run("bakerd", *arguments, timeout=20), "bakerd: ", part, status=USAGE
                )

    def test_options_can_stand_in_a_file(self):
        config = self.farm.path("bakerd.ini")
        with open(config, "w", encoding="utf-8") as file:
            file.write("[serve]\nthreads = 1\n")
        self.assertIn("bakes on 1 threads", self.farm.daemon("data", "--config", config).log())
        with open(config, "w", encoding="utf-8") as file:
            file.write("[serve]\ntreads = 1\n")
        self.assert_sentence(
            self.farm.run(
                "bakerd", "serve", "--data", self.farm.path("other"), "--config", config, timeout=20
            ),
            "treads",
        )

    def test_terminated_daemon_stops_cleanly_and_goes_on_later(self):
        daemon = self.farm.daemon()
        self.farm.bake(daemon, "submit", self.island(), *REGION, *FEW_RAYS)
        wait_until(lambda: self.farm.job(daemon, 1)["sectors_done"] >= 1, what="the first sector")
        self.assertEqual(daemon.stop(), 0)
        self.assertIn("stopped", daemon.log())
        daemon.start()
        self.assertEqual(self.farm.bake(daemon, "watch", "1").returncode, 0)

    @unittest.skipUnless(os.geteuid() == 0, "needs root to make a small disk")
    def test_full_disk_fails_the_upload_with_a_sentence(self):
        island = self.island(700)
        os.mkdir(self.farm.path("disk"))
        with tiny_disk(self.farm.path("disk"), 600 * 1024):
            daemon = farm_fixture.Daemon(OPTIONS.bin, self.farm.path("disk/data"))
            try:
                done = self.farm.bake(daemon, "submit", island)
                self.assert_sentence(done, "No space left on device", status=SERVER)
                self.assertEqual(self.farm.bake(daemon, "list").returncode, 0)
            finally:
                daemon.kill()

    def test_refused_map_leaves_no_job(self):
        daemon = self.farm.daemon()
        broken = self.farm.path("broken.gltf")
        with open(broken, "w", encoding="utf-8") as file:
            file.write('{"asset": {"version": "2.0"}, "nodes": [{"mesh": 3}], "scenes": [{"nodes": [0]}]}')
        self.assert_sentence(
            self.farm.bake(daemon, "submit", broken), "broken.gltf", "node 0", "mesh", status=INVALID
        )
        with open(broken, "w", encoding="utf-8") as file:
            file.write(
                '{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 3, "uri": "../secret.bin"}]}'
            )
        self.assert_sentence(self.farm.bake(daemon, "submit", broken), "leaves the map's folder")
        self.assertEqual(self.farm.bake(daemon, "list").stdout.count("\n"), 1)


class Store(FarmTest):
    """Blobs beside the data folder."""

    def test_a_store_of_its_own_holds_all_but_the_database(self):
        store, data = self.farm.path("share/store"), self.farm.path("data")
        daemon = self.farm.daemon("data", "--store", store)
        lawn = write_map(self.farm.path("map.gltf"), lawn=LAWN)
        pulled = self.pulled(daemon, lawn, *FEW_RAYS)
        self.assertEqual(len(pulled), 1)
        digest = hashlib.sha256(pulled["sector_0_0.drtv"]).hexdigest()
        self.assertTrue(os.path.exists(f"{store}/blobs/objects/{digest[:2]}/{digest}"))
        self.assertFalse(os.path.exists(data + "/blobs"))
        # It is found again after a restart, and serves no other daemon.
        daemon.stop()
        daemon.start()
        done = self.farm.bake(daemon, "pull", "1", "--out", self.farm.path("again"))
        self.assertEqual(done.returncode, 0, done.stderr)
        daemon.stop()
        os.rename(store, store + "_away")
        refused = self.farm.run("bakerd", "serve", "--data", data, "--store", store)
        self.assert_sentence(refused, "is it mounted?", store, status=UNREADABLE)
        shutil.rmtree(store)
        os.rename(store + "_away", store)
        refused = self.farm.run("bakerd", "serve", "--data", self.farm.path("other"), "--store", store)
        self.assert_sentence(refused, "belongs to another daemon's data folder", store, status=UNREADABLE)


class Incremental(FarmTest):
    def job_of(self, daemon, *arguments, name="pulled"):
        """Submits and pulls; gives the job at its end."""
        done = self.farm.bake(daemon, "--json", "submit", *arguments, "--pull", self.farm.path(name))
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        return self.farm.job(daemon, last_object(done)["job"])

    def test_edits_bake_what_they_changed_and_no_byte_less(self):
        """A few of what edits.py does by the hundred."""
        done = subprocess.run(
            [
                sys.executable,
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "edits.py"),
                "--bin",
                OPTIONS.bin,
                "--edits",
                "10",
                "--sequence",
                "5",
                "--rays",
                "64",
                "--plants",
                "700",
                "--seed",
                "4",
                "--region=-130,-190,250,120",
            ],
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_a_plan_says_what_a_job_then_does(self):
        daemon = self.farm.daemon()
        edited = map_edits.EditableMap(self.island())
        first = edited.write(self.farm.path("first"))
        fresh = last_object(self.farm.bake(daemon, "--json", "plan", first, *REGION, *FEW_RAYS))
        self.assertEqual((fresh["hits"], fresh["rebakes"]), (0, 35))
        self.assertEqual(fresh["sectors"][0]["reason"], "it was not baked with these settings before")
        self.assertEqual(self.job_of(daemon, first, *REGION, *FEW_RAYS)["sectors_cached"], 0)
        self.assertEqual(
            last_object(self.farm.bake(daemon, "--json", "plan", first, *REGION, *FEW_RAYS))["hits"], 35
        )

        number = edited.plants()[0]
        edited.nodes[number]["name"] = "the_palm"
        self.assertEqual(
            last_object(
                self.farm.bake(
                    daemon, "--json", "plan", edited.write(self.farm.path("named")), *REGION, *FEW_RAYS
                )
            )["hits"],
            35,
        )
        self.job_of(daemon, self.farm.path("named"), *REGION, *FEW_RAYS)
        # One that every rock of this sector sees: the crater's middle.
        edited.nodes[number]["translation"] = [60.0, 60.0, 10.0]
        moved = edited.write(self.farm.path("moved"))
        picture = self.farm.path("plan.png")
        plan = last_object(
            self.farm.bake(daemon, "--json", "plan", moved, *REGION, *FEW_RAYS, "--png", picture)
        )
        self.assertEqual(plan["hits"] + plan["near_hits"] + plan["rebakes"], 35)
        self.assertGreater(plan["rebakes"], 0)
        self.assertGreater(plan["seconds"], 0)
        self.assertTrue(any("the_palm" in change["what"] for change in plan["changes"]), plan["changes"])
        for sector in plan["sectors"]:
            self.assertEqual("reason" in sector, sector["verdict"] != "hit", sector)
        drawn = png_file.read(picture)
        self.assertGreaterEqual(min(drawn.width, drawn.height), 512)
        colours = {"hit": (70, 120, 80), "near hit": (230, 190, 60), "rebake": (205, 70, 60)}
        for sector in plan["sectors"]:
            i, j = sector["sector"]
            self.assertEqual(drawn.at(64 * i + 3, 64 * j + 3), colours[sector["verdict"]], sector)
        under = self.farm.path("under.png")
        green = self.farm.path("green.png")
        for arguments in ((first, "--png", green), (moved, "--png", under, "--under", green)):
            done = self.farm.bake(daemon, "plan", *arguments, *REGION, *FEW_RAYS)
            self.assertEqual(done.returncode, 0, done.stderr)
        i, j = next(sector["sector"] for sector in plan["sectors"] if sector["verdict"] == "rebake")
        red, green, _ = png_file.read(under).at(64 * i + 30, 64 * j + 30)
        self.assertTrue(70 < red < 205 and 70 < green < 120, (red, green))
        done = self.farm.bake(daemon, "plan", moved, "--png", self.farm.path("plan.jpg"))
        self.assert_sentence(done, "plan.jpg", ".png", status=USAGE)
        done = self.farm.bake(daemon, "plan", moved, "--png", under, "--under", self.farm.path("no.png"))
        self.assert_sentence(done, "no.png", status=UNREADABLE)
        done = self.farm.bake(daemon, "plan", moved, "--png", under, "--under", under)
        self.assert_sentence(done, "would replace the picture of --under", status=USAGE)
        text = self.farm.bake(daemon, "plan", moved, *REGION, *FEW_RAYS).stdout
        self.assertIn(f"{plan['rebakes']} to bake, about ", text)
        self.assertIn("the_palm", text)

        job = self.job_of(daemon, moved, *REGION, *FEW_RAYS)
        self.assertEqual((job["sectors_cached"], job["sectors_near"]), (plan["hits"], plan["near_hits"]))
        undone = self.job_of(daemon, first, *REGION, *FEW_RAYS)
        self.assertEqual(undone["sectors_cached"], 35)
        exact = self.job_of(daemon, moved, *REGION, *FEW_RAYS, "--exact", name="exact")
        self.assertEqual((exact["sectors_near"], exact["largest_bound"]), (0, 0))
        other = self.farm.daemon("other")
        self.assertEqual(
            self.pulled(other, moved, *REGION, *FEW_RAYS, "--exact", name="from_nothing"),
            read_folder(self.farm.path("exact")),
        )

    def test_two_clients_at_once_bake_each_sector_once(self):
        daemon = self.farm.daemon()
        island = self.island()
        clients = [
            self.farm.start_bake(
                daemon, "submit", island, *REGION, *FEW_RAYS, "--pull", self.farm.path(f"client_{n}")
            )
            for n in range(2)
        ]
        for client in clients:
            client.communicate(timeout=120)
            self.assertEqual(client.returncode, 0)
        self.assertEqual(read_folder(self.farm.path("client_0")), read_folder(self.farm.path("client_1")))
        self.assertEqual(json.loads(self.farm.bake(daemon, "--json", "cache").stdout)["baked"], 35)

    def test_the_cache_is_shown_limited_and_cleared(self):
        daemon = self.farm.daemon("data", "--cache-size", "300KB")
        island = self.island()
        self.pulled(daemon, island, *REGION, *FEW_RAYS)
        shown = json.loads(self.farm.bake(daemon, "--json", "cache").stdout)
        self.assertEqual((shown["limit"], shown["baked"], shown["hits"]), (300000, 35, 0))
        self.pulled(daemon, island, *REGION, "--preset", "draft", "--set", "rays=32", name="other")
        self.assertEqual(len(read_folder(self.farm.path("other"))), 35)
        self.pulled(
            daemon, island, "--region", "0,0,1,1", "--preset", "draft", "--set", "rays=16", name="third"
        )
        shown = json.loads(self.farm.bake(daemon, "--json", "cache").stdout)
        self.assertLessEqual(shown["size"], 300000)
        self.assertGreater(shown["results"], 0)
        self.assertIn("hit rate", self.farm.bake(daemon, "cache").stdout)
        self.assertEqual(
            json.loads(self.farm.bake(daemon, "--json", "cache", "--clear").stdout)["results"], 0
        )
        self.assert_sentence(
            self.farm.run(
                "bakerd", "serve", "--data", self.farm.path("x"), "--cache-size", "much", timeout=20
            ),
            "--cache-size",
            status=USAGE,
        )
        self.assert_sentence(
            self.farm.bake(
                daemon, "plan", island, "--png", self.farm.path("no/folder.png"), *REGION, *FEW_RAYS
            ),
            "no/folder.png",
            status=UNREADABLE,
        )
        self.assert_sentence(
            self.farm.bake(daemon, "plan", island, "--set", "tolerance=2"),
            "tolerance",
            "0.0625",
            status=USAGE,
        )


NO_PROBE = "no probe was placed"
# What a map is told that has no place for a probe, as one triangle that stands upright.
NO_PLACE = ("has no ground", "no surface of the map faces up", NO_PROBE)


class RealMaps(FarmTest):
    """Every valid map of the shared data bakes; every invalid one is refused in a sentence."""

    def setUp(self):
        if not os.path.isdir(OPTIONS.data):
            self.skipTest(f"no maps at {OPTIONS.data}")
        super().setUp()
        self.daemon = self.farm.daemon()

    def documents(self, folder):
        found = []
        for path, _, names in os.walk(os.path.join(OPTIONS.data, folder)):
            found += [os.path.join(path, name) for name in sorted(names) if name.endswith((".glb", ".gltf"))]
        return sorted(found)

    def assert_bakes(self, path, *settings):
        done = self.farm.bake(
            self.daemon,
            "--json",
            "submit",
            path,
            "--preset",
            "draft",
            "--set",
            "rays=16",
            *settings,
            "--wait",
        )
        ended = last_object(done)
        # A prop may be too small for a column of the lattice to meet it: the bake is whole, and no success.
        self.assertEqual(done.returncode, 0 if ended["probes"] else INVALID, path + ": " + done.stderr)
        self.assertEqual(NO_PROBE in done.stderr, not ended["probes"], done.stderr)
        self.assertEqual(ended["state"], "succeeded")
        return ended

    def test_models_and_scenes_bake(self):
        for folder in (
            "A1_maunga_whau",
            "B_kenney_nature",
            "B_kenney_pirate",
            "B_kenney_watercraft",
            "B_polyhaven_dutch_ship",
            "B_polyhaven_fern",
            "B_quaternius_nature",
            "B_quaternius_props",
            "C_cornell",
            "C_zdm2",
            "M_desert",
        ):
            for path in self.documents(folder):
                with self.subTest(path=path):
                    self.assert_bakes(path)

    def test_sponza_bakes_and_has_probes(self):
        (path,) = self.documents("C_sponza")
        self.assertGreater(self.assert_bakes(path)["probes"], 10)

    def test_larger_elevation_model_bakes(self):
        """Twenty square kilometres of it; the whole is a soak (CONTRIBUTING)."""
        for path in self.documents("A2_tutuila"):
            with self.subTest(path=path):
                self.assertGreater(self.assert_bakes(path, "--region", "0,-500,500,-1")["probes"], 500)

    def test_importer_corpus(self):
        with open(os.path.join(OPTIONS.data, "E_importer/manifest.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        unsupported = (
            "KHR_draco_mesh_compression",
            "EXT_meshopt_compression",
            "EXT_texture_webp",
            "KHR_texture_basisu",
        )
        for row in rows:
            kind, path = row["file"].split("/")[0], os.path.join(OPTIONS.data, "E_importer", row["file"])
            if kind not in ("valid", "invalid"):
                continue
            with self.subTest(file=row["file"]):
                done = self.farm.bake(
                    self.daemon, "submit", path, "--preset", "draft", "--set", "rays=16", "--wait"
                )
                if kind == "valid" and done.returncode == 0:
                    continue
                if kind == "valid" and any(said in done.stderr for said in NO_PLACE):
                    self.assertEqual(done.returncode, INVALID)
                    continue
                self.assert_sentence(done, os.path.basename(path), status=INVALID)
                if kind == "valid":
                    with open(path, "rb") as document:
                        text = document.read()
                    self.assertTrue(any(name.encode() in text for name in unsupported), done.stderr)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", required=True)
    parser.add_argument("--data", default="")
    parser.add_argument("case", nargs="*")
    OPTIONS.__dict__.update(vars(parser.parse_args()))
    program = unittest.main(argv=[sys.argv[0], "--verbose", *OPTIONS.case], exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if program.result.skipped and len(program.result.skipped) == program.result.testsRun else 0)


main()
