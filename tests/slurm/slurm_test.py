#!/usr/bin/python3
"""The daemon on a real Slurm cluster, whose nodes and controller are killed, beside the daemon on this machine alone.

    slurm_test.py --bin build/ci/bin Short             what tests/run.sh runs: three minutes at most
    slurm_test.py --bin build/ci/bin Faults            1,000 sectors, a node killed every 20 s; a quarter of an hour
    slurm_test.py --bin build/ci/bin Many              25,000 sectors
    slurm_test.py --bin build/ci/bin Edits             an artist's, while a night fills the cluster; some minutes
    slurm_test.py --bin build/ci/bin --data ../shared/data Simulated     beside simulate_farm; some minutes
    slurm_test.py --bin build/ci/bin --data ../shared/data SameBytes
"""
import argparse
import collections
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "e2e"))
sys.path.insert(0, HERE)
import cluster as slurm
from farm_fixture import Farm, make_island, read_folder, wait_until
from small_maps import write_map

SKIPPED = 77
OPTIONS = None
# Slurm's sbatch, after which the daemon that called it dies once, before it hears of the result.
DEADLY_SBATCH = """#!/bin/sh
{sbatch} "$@"
status=$?
if [ -e {mark} ]; then
  rm {mark}
  kill -9 $PPID
fi
exit $status
"""


def write_field(path, side, height=16):
    """A map of side x side sectors, of which each is quick to bake: a lawn with a wall in each, that high in the first."""
    quads = {}
    for j in range(side):
        for i in range(side):
            x, y = 64 * i, 64 * j
            quads[f"lawn {i} {j}"] = [(x, y, 0), (x + 64, y, 0), (x + 64, y + 64, 0), (x, y + 64, 0)]
            quads[f"wall {i} {j}"] = [
                (x + 8, y + 30, 0),
                (x + 56, y + 30, 0),
                (x + 56, y + 30, 16 + (i + j) % 5),
                (x + 8, y + 30, 16),
            ]
    quads["wall 0 0"][3] = (8, 30, height)
    return write_map(path, **quads)


def write_stones(path, side):
    """A map of side x side sectors that take next to no time: in each a stone to stand on."""
    quads = {}
    for j in range(side):
        for i in range(side):
            x, y = 64 * i + 30, 64 * j + 30
            quads[f"stone {i} {j}"] = [(x, y, 0), (x + 4, y, 0), (x + 4, y + 4, 0), (x, y + 4, 0)]
    return write_map(path, **quads)


class SlurmCase(unittest.TestCase):
    NODES, THREADS = 4, 1
    CLUSTER = {}

    def setUp(self):
        self.farm = Farm(OPTIONS.bin)
        self.addCleanup(self.farm.close)
        self.cluster = slurm.Cluster(self.farm.path("slurm"), self.NODES, self.THREADS, **self.CLUSTER)
        self.addCleanup(self.cluster.down)
        self.cluster.up()
        tools = self.farm.path("tools")
        os.mkdir(tools)
        self.mark = self.farm.path("die")
        with open(os.path.join(tools, "sbatch"), "w", encoding="utf-8") as file:
            file.write(DEADLY_SBATCH.format(sbatch="/usr/bin/sbatch", mark=self.mark))
        os.chmod(os.path.join(tools, "sbatch"), 0o755)
        old = {name: os.environ.get(name) for name in ("SLURM_CONF", "PATH")}
        self.addCleanup(lambda: os.environ.update({name: value or "" for name, value in old.items()}))
        os.environ["SLURM_CONF"] = self.cluster.config
        os.environ["PATH"] = tools + ":" + os.environ["PATH"]
        self.store = self.farm.path("store")

    def slurm_daemon(self, *options, name="slurm_data"):
        return self.farm.daemon(
            name, "--executor", "slurm", "--store", self.store, "--threads", "1", *options
        )

    def bake(self, daemon, *arguments, **named):
        done = self.farm.bake(daemon, *arguments, **named)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def job(self, daemon, number=1):
        return self.farm.job(daemon, number)

    def wait_for_job(self, daemon, number=1, patience_s=900):
        wait_until(
            lambda: self.job(daemon, number)["state"] not in ("running", "waiting"),
            patience_s,
            "the job's end",
        )
        self.assertEqual(self.job(daemon, number)["state"], "succeeded", daemon.log()[-4000:])

    def files(self, daemon, number, name):
        folder = self.farm.path(name)
        self.bake(daemon, "pull", str(number), "--out", folder)
        return read_folder(folder)

    def expect_same_files(self, daemon, number, local, local_number=1):
        ours = self.files(daemon, number, f"pulled_{number}")
        theirs = self.files(local, local_number, f"pulled_local_{local_number}")
        self.assertEqual(ours.keys(), theirs.keys())
        self.assertTrue(ours)
        different = [name for name in ours if ours[name] != theirs[name]]
        self.assertEqual(different, [])

    def baked(self):
        """How often each sector was baked to its end, by what tasks printed."""
        counts = collections.Counter()
        logs = os.path.join(self.store, "logs")
        for folder, _, names in os.walk(logs):
            for name in names:
                with open(os.path.join(folder, name), encoding="utf-8", errors="replace") as file:
                    counts.update(re.findall(r"sector (\(-?\d+, -?\d+\)): \d+ probes", file.read()))
        return counts

    def wasted(self):
        counts = self.baked()
        return 1 - len(counts) / max(sum(counts.values()), 1)

    def expect_clean_store(self):
        """No half-written file, and no array that is open."""
        for part in ("blobs/tmp", "answers/tmp"):
            left = os.listdir(os.path.join(self.store, part))
            self.assertEqual([name for name in left if not self._is_of_killed(name)], [], part)
        with open(os.path.join(self.store, "owner"), encoding="utf-8") as file:
            arrays = os.path.join(self.store, "arrays", file.readline().strip())
        wait_until(lambda: os.listdir(arrays) == ["tmp"], 120, "the arrays' end")

    @staticmethod
    def _is_of_killed(name):
        """The temporary file of a process that is gone: nobody will read it, and it goes at the next start."""
        found = re.search(r"\.(\d+)\.\d+$", name)
        return found is not None and not os.path.exists(f"/proc/{found.group(1)}")


class Short(SlurmCase):
    """One node's and one daemon's death."""

    def expect_doctor_is_content(self):
        doctor = os.path.join(OPTIONS.bin, "bakerd")
        done = self.cluster.run("srun", "--nodelist=node1", doctor, "doctor", "--store", self.store)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("4 of 4 nodes can bake", done.stdout)
        done = self.cluster.run(doctor, "doctor", "--store", self.farm.path("nowhere"))
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"FAULT +store +\S+ is no daemon's store")

    def test_a_node_and_the_daemon_die(self):
        field = write_field(self.farm.path("map/field.gltf"), 10)
        settings = ["--preset", "draft", "--set", "rays=8192"]
        local = self.farm.daemon("local_data")
        self.bake(local, "submit", field, *settings, "--wait", "--yes")
        daemon = self.slurm_daemon("--slurm-batch", "4")
        self.expect_doctor_is_content()
        self.bake(daemon, "submit", field, *settings, "--yes", "--priority", "nightly")
        wait_until(lambda: self.job(daemon)["sectors_done"] >= 8, 60, "the first sectors")
        self.assertEqual(self.job(daemon)["cluster"]["nodes"], 4)
        self.cluster.kill("node2")
        open(self.mark, "w", encoding="utf-8").close()
        time.sleep(1)
        if os.path.exists(self.mark):  # no array was submitted in between
            daemon.kill()
            os.remove(self.mark)
        wait_until(lambda: daemon.process.poll() is not None, 30, "the daemon's death")
        self.cluster.start("node2")
        daemon.start()
        self.wait_for_job(daemon, patience_s=120)
        self.expect_same_files(daemon, 1, local)
        self.assertEqual(len(self.baked()), 100)
        log = json.loads(self.bake(daemon, "--json", "logs", "1", "3,4").stdout)
        self.assertIn(log["node"], self.cluster.names)
        self.assertTrue(log["lines"] and all("sector (3, 4)" in line for line in log["lines"]), log)
        self.expect_clean_store()
        self.assertEqual(daemon.stop(), 0)


class Faults(SlurmCase):
    """1,000 sectors on four nodes: a node is killed every 20 s and comes back after 5 s, the controller dies once in good order
    and once not, the daemon three times, once between sbatch and its record."""

    def kill_nodes(self, stop, log):
        turn = 0
        while not stop.wait(15):
            name = self.cluster.names[turn % len(self.cluster.names)]
            turn += 1
            self.cluster.kill(name)
            log.append(name)
            if stop.wait(5):
                break
            self.cluster.start(name)

    def submit_and_die(self, daemon, field):
        """Another job, an artist's, so that there is an array to submit."""
        open(self.mark, "w", encoding="utf-8").close()
        self.farm.bake(
            daemon,
            "submit",
            field,
            "--preset",
            "draft",
            "--set",
            "rays=64",
            "--region",
            "0,0,255,255",
            "--yes",
        )

    def test_all_is_delivered(self):
        field = write_field(self.farm.path("map/field.gltf"), 32)
        settings = ["--preset", "draft", "--set", f"rays={OPTIONS.rays}"]
        local = self.farm.daemon("local_data")
        begin = time.monotonic()
        self.bake(local, "submit", field, *settings, "--wait", "--yes", timeout=3600)
        local_s = time.monotonic() - begin
        daemon = self.slurm_daemon("--slurm-batch", "10", "--slurm-resume-nodes")
        begin = time.monotonic()
        self.bake(daemon, "submit", field, *settings, "--yes", "--priority", "nightly")
        stop, killed = threading.Event(), []
        nodes = threading.Thread(target=self.kill_nodes, args=(stop, killed))
        nodes.start()
        events = [
            (20, "the daemon", daemon.kill),
            (40, "the controller, in good order", lambda: self.cluster.kill("controller", signal.SIGTERM)),
            (70, "the daemon after sbatch", lambda: self.submit_and_die(daemon, field)),
            (100, "the controller", lambda: self.cluster.kill("controller")),
            (130, "the daemon", daemon.kill),
        ]
        deaths = []
        try:
            while True:
                passed = time.monotonic() - begin
                self.assertLess(passed, 1800)
                while events and passed > events[0][0]:
                    _, what, strike = events.pop(0)
                    print(f"{passed:.0f} s: {what}", flush=True)
                    strike()
                    if what.startswith("the controller"):
                        time.sleep(2)
                        self.cluster.start("controller")
                if daemon.process.poll() is not None:
                    deaths.append(passed)
                    time.sleep(1)
                    daemon.start()
                if not events and self.job(daemon)["state"] not in ("running", "waiting"):
                    break
                time.sleep(0.5)
        finally:
            stop.set()
            nodes.join()
        took = time.monotonic() - begin
        self.assertEqual(self.job(daemon)["state"], "succeeded", daemon.log()[-4000:])
        self.wait_for_job(daemon, 2)
        self.assertFalse(os.path.exists(self.mark), "the daemon did not die after sbatch")
        wasted = self.wasted()
        print(
            f"{len(self.baked())} sectors in {took:.0f} s (this machine alone: {local_s:.0f} s); {len(killed)} nodes killed, "
            f"{len(deaths)} daemons; {100 * wasted:.1f} % of the baked sectors were not used",
            flush=True,
        )
        self.assertGreaterEqual(len(deaths), 3)
        self.expect_same_files(daemon, 1, local)
        self.expect_clean_store()
        self.assertLess(wasted, 0.1)


class Many(SlurmCase):
    """25,000 tiny sectors, on nodes that claim more processors than there are."""

    NODES, THREADS = 4, 8

    def memory_mb(self, daemon):
        with open(f"/proc/{daemon.process.pid}/status", encoding="utf-8") as file:
            return int(re.search(r"VmRSS:\s+(\d+)", file.read()).group(1)) / 1024

    def processor_s(self, daemon):
        with open(f"/proc/{daemon.process.pid}/stat", encoding="utf-8") as file:
            user, system = file.read().rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def test_25000_sectors_are_one_job(self):
        stones = write_stones(self.farm.path("map/stones.gltf"), 158)
        settings = ["--preset", "draft", "--set", "rays=16", "--set", "bounces=0"]
        tools = self.farm.path("tools")
        with open(os.path.join(tools, "squeue"), "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\ndate +%s.%N >> {self.farm.path("squeues")}\nexec /usr/bin/squeue "$@"\n')
        os.chmod(os.path.join(tools, "squeue"), 0o755)
        daemon = self.slurm_daemon()
        self.bake(daemon, "plan", stones, *settings, timeout=900)
        begin = time.monotonic()
        self.bake(daemon, "submit", stones, *settings, "--yes", "--priority", "nightly", timeout=900)
        accepted = time.monotonic() - begin
        before_s = self.processor_s(daemon)
        peaks = []
        while self.job(daemon)["state"] in ("running", "waiting"):
            peaks.append(self.memory_mb(daemon))
            time.sleep(2)
        took = time.monotonic() - begin
        self.assertEqual(self.job(daemon)["state"], "succeeded")
        with open(self.farm.path("squeues"), encoding="utf-8") as file:
            asked = [float(line) for line in file]
        gaps = [after - before for before, after in zip(asked, asked[1:])]
        print(
            f"accepted in {accepted:.1f} s, done in {took:.0f} s; squeue {len(asked)} times, {min(gaps):.1f} s apart at least; "
            f"the daemon's processor time {self.processor_s(daemon) - before_s:.1f} s, its memory {peaks[0]:.0f} MB at first, {max(peaks):.0f} MB at most, {peaks[-1]:.0f} MB at last",
            flush=True,
        )
        self.assertLess(accepted, 5)
        self.assertGreaterEqual(min(gaps), 4.9)
        self.assertLess(max(peaks) - peaks[0], 100)


class Edits(SlurmCase):
    """Edits of an artist while a night fills the cluster with batches of the usual length."""

    def test_the_first_sector_comes_soon(self):
        field = write_field(self.farm.path("map/field.gltf"), 32)
        settings = ["--preset", "draft", "--set", f"rays={OPTIONS.rays}"]
        daemon = self.slurm_daemon()
        self.bake(daemon, "submit", field, *settings, "--yes", "--priority", "nightly")

        def is_full():
            cluster = self.job(daemon)["cluster"]
            return self.job(daemon)["sectors_done"] > 100 and cluster["tasks_running"] == self.NODES

        wait_until(is_full, 300, "a full cluster")
        waits = []
        for edit in range(1, 6):
            edited = write_field(self.farm.path(f"edit{edit}/field.gltf"), 32, height=16 + edit)
            begin = time.monotonic()
            self.bake(daemon, "submit", edited, *settings, "--yes", "--region", "0,0,127,127")
            wait_until(lambda: self.job(daemon, edit + 1)["sectors_done"] > 0, 600, "the edit's first sector")
            waits.append(time.monotonic() - begin)
            night = self.job(daemon)
            self.assertEqual(night["state"], "running", "the night was to fill the cluster")
            time.sleep(13)
        print(f"first sectors of edits after {', '.join(f'{wait:.0f}' for wait in waits)} s", flush=True)
        self.assertLess(max(waits), 120)


class Simulated(SlurmCase):
    """A night on four nodes takes what simulate_farm says, fed with what the same sectors cost on this machine."""

    def test_four_nodes(self):
        path = os.path.join(OPTIONS.data, "maps/volcano_island.glb")
        settings = ["--preset", "pc", "--exact"]
        if not os.path.exists(path):
            path = write_field(self.farm.path("map/field.gltf"), 16)
            settings = ["--preset", "draft", "--set", "rays=32768"]
        # As many threads share the processors as nodes will.
        local = self.farm.daemon("local_data", "--threads", str(self.NODES))
        begin = time.monotonic()
        self.bake(local, "plan", path, *settings)
        load_s = time.monotonic() - begin
        self.bake(local, "submit", path, *settings, "--wait", "--yes", timeout=3600)
        local.stop()
        costs = self.farm.path("costs.json")
        with open(costs, "w", encoding="utf-8") as file:
            subprocess.run(
                [sys.executable, os.path.join(HERE, "sector_costs.py"), self.farm.path("local_data")],
                stdout=file,
                check=True,
            )
        with open(costs, encoding="utf-8") as file:
            sectors = len(json.load(file)["sectors"])
        # Nodes load their maps beside each other.
        load_s *= self.NODES * self.THREADS / os.cpu_count()
        options = f"--nodes {self.NODES} --threads {self.THREADS} --sectors {sectors} --batch 10 --load {load_s:.1f}"
        simulate = os.path.join(OPTIONS.bin, "../tests/simulate_farm")
        said = subprocess.run([simulate, costs, *options.split()], capture_output=True, check=True, text=True)
        simulated = json.loads(said.stdout)
        daemon = self.slurm_daemon("--slurm-batch", "10")
        begin = time.monotonic()
        self.bake(daemon, "submit", path, *settings, "--wait", "--yes", "--priority", "nightly", timeout=3600)
        # The client uploads the map, and the daemon looks at it.
        took = time.monotonic() - begin - load_s
        print(f"simulate_farm {options}: {simulated}; on the cluster {took:.1f} s", flush=True)
        self.assertLess(abs(simulated["seconds"] / took - 1), 0.15)


class SameBytes(SlurmCase):
    """The demo island, and a real map where there is one."""

    def expect_same(self, path, *settings):
        local = self.farm.daemon("local_" + os.path.basename(path))
        self.bake(local, "submit", path, *settings, "--wait", "--yes", timeout=3600)
        daemon = self.slurm_daemon(name="slurm_data")
        job = json.loads(
            self.bake(
                daemon, "--json", "submit", path, *settings, "--wait", "--yes", timeout=3600
            ).stdout.split("\n")[0]
        )
        number = int(re.search(r"\d+", str(job.get("id", job.get("name", "1")))).group())
        self.expect_same_files(daemon, number, local)
        daemon.stop()

    def test_demo_island(self):
        self.expect_same(make_island(self.farm.path("island"), 300), "--preset", "draft", "--exact")

    def test_volcano_island(self):
        path = os.path.join(OPTIONS.data, "maps/volcano_island.glb")
        if not os.path.exists(path):
            self.skipTest(f"there is no {path}")
        self.expect_same(path, "--preset", "draft", "--exact")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="folder of bake and bakerd")
    parser.add_argument("--data", default="/nowhere", help="folder of real maps")
    parser.add_argument(
        "--rays", type=int, default=16384, help="of the sectors of Faults: how long they take"
    )
    parser.add_argument("tests", nargs="+")
    global OPTIONS
    OPTIONS = parser.parse_args()
    OPTIONS.bin = os.path.abspath(OPTIONS.bin)
    if missing := slurm.missing_programs():
        print(f"there is no {missing[0]}: nothing was tested")
        sys.exit(SKIPPED)
    sys.argv = [sys.argv[0], *OPTIONS.tests]
    unittest.main(module="__main__", verbosity=2)


if __name__ == "__main__":
    main()
