"""A daemon with a folder of its own, and the client against it."""
import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import json_lines

SOURCE_DIR = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
START_PATIENCE_S = 20


class Daemon:
    """`bakerd serve` in a folder; stops with the test. Its address is chosen by the system."""

    def __init__(self, bin_dir, folder, *options, listen="127.0.0.1:0"):
        self.bin_dir, self.folder, self.options, self.listen = bin_dir, folder, options, listen
        self.log_path = folder + ".log"
        self.process = None
        self.address = None
        self.start()

    def start(self):
        with open(self.log_path, "ab") as log:
            mark = log.tell()
            self.process = subprocess.Popen(
                [
                    os.path.join(self.bin_dir, "bakerd"),
                    "serve",
                    "--data",
                    self.folder,
                    "--listen",
                    self.listen,
                    *self.options,
                ],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )
        deadline = time.monotonic() + START_PATIENCE_S
        while time.monotonic() < deadline:
            found = re.search(r"bakerd listens on ([^,]+),", self.log(mark))
            if found:
                self.address = self.listen = found.group(1)
                return
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        raise AssertionError("bakerd did not start: " + self.log(mark))

    def log(self, start=0):
        with open(self.log_path, "rb") as log:
            log.seek(start)
            return log.read().decode()

    def worker_pid(self):
        """Of the worker started last, or None."""
        started = re.findall(r"worker (\d+) started", self.log())
        return int(started[-1]) if started else None

    def kill(self):
        self.process.kill()
        self.process.wait()

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=30)


class Farm:
    """Binaries, a scratch folder, and short words for what tests do."""

    def __init__(self, bin_dir):
        self.bin_dir = bin_dir
        self.scratch = tempfile.TemporaryDirectory(prefix="drtv_e2e_")
        self.daemons = []

    def path(self, name):
        return os.path.join(self.scratch.name, name)

    def daemon(self, name="data", *options, **named):
        daemon = Daemon(self.bin_dir, self.path(name), *options, **named)
        self.daemons.append(daemon)
        return daemon

    def close(self):
        for daemon in self.daemons:
            if daemon.process.poll() is None:
                daemon.kill()
        self.scratch.cleanup()

    def run(self, program, *arguments, timeout=300, env=None):
        done = subprocess.run(
            [os.path.join(self.bin_dir, program), *arguments],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
            env={**os.environ, **(env or {})},
        )
        done.stderr = json_lines.read(program, arguments, done.stdout, done.stderr)
        return done

    def bake(self, daemon, *arguments, **named):
        return self.run("bake", "--server", daemon.address, *arguments, **named)

    def start_bake(self, daemon, *arguments):
        return subprocess.Popen(
            [os.path.join(self.bin_dir, "bake"), "--server", daemon.address, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def job(self, daemon, number):
        return json.loads(self.bake(daemon, "--json", "status", str(number)).stdout)


def make_island(folder, plants):
    subprocess.run(
        [
            sys.executable,
            os.path.join(SOURCE_DIR, "deploy/demo_map/make_demo_map.py"),
            "--out",
            folder,
            "--plants",
            str(plants),
        ],
        check=True,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )
    return os.path.join(folder, "island.gltf")


def read_folder(folder):
    """Name of each sector file -> its bytes."""
    contents = {}
    for name in sorted(os.listdir(folder)):
        if not name.endswith(".drtv"):
            continue
        with open(os.path.join(folder, name), "rb") as file:
            contents[name] = file.read()
    return contents


def wait_until(condition, patience_s=60.0, what="a condition"):
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        time.sleep(0.01)
    raise AssertionError(f"waited {patience_s} s in vain for {what}")


@contextlib.contextmanager
def tiny_disk(folder, size):
    """A file system of `size` bytes at `folder`; needs root."""
    os.makedirs(folder, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)
