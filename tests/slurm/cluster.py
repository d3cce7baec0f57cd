#!/usr/bin/python3
"""A private Slurm cluster on this machine: a controller, munge and several nodes, of this user, on loopback, in one folder.

    cluster.py up FOLDER [--nodes 4] [--threads 2]    then: export SLURM_CONF=FOLDER/slurm.conf
    cluster.py kill FOLDER node2                      as a power cut: the node and all that runs on it
    cluster.py start FOLDER node2
    cluster.py down FOLDER

Debian's slurmd can run several times on one machine (MULTIPLE_SLURMD). Needs slurmctld, slurmd, slurm-client and munge."""
import argparse
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time

PROGRAMS = ("slurmctld", "slurmd", "squeue", "munged")
PATIENCE_S = 60
CONFIG = """\
ClusterName=drtv
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=15
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/state/slurmctld.pid
SlurmdPidFile={folder}/spool/%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/%n.log
MailProg=/bin/true
SlurmdTimeout=10
SlurmctldTimeout=10
MessageTimeout=5
TCPTimeout=2
BatchStartTimeout=10
KillWait=3
InactiveLimit=0
ReturnToService=2
JobRequeue=1
UnkillableStepTimeout=20
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=5,batch_sched_delay=1,sched_min_interval=100000,sched_interval=5,default_queue_depth=1000,\
max_array_tasks={max_array}
PriorityType=priority/basic
MaxArraySize={max_array}
MaxJobCount=60000
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SlurmdParameters=config_overrides
{more}
{nodes}
PartitionName=bake Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""


def missing_programs():
    path = os.environ.get("PATH", "") + ":/usr/sbin"
    return [program for program in PROGRAMS if shutil.which(program, path=path) is None]


def free_ports(count):
    """Nobody else's at this moment."""
    sockets = [socket.socket() for _ in range(count)]
    try:
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()


def processes():
    """Each process's number, its parent's, and its environment as far as it may be read."""
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8") as file:
                state, parent = file.read().rsplit(")", 1)[1].split()[:2]
            with open(f"/proc/{name}/environ", "rb") as file:
                environment = file.read().split(b"\0")
        except OSError:
            continue
        if state != "Z":
            yield int(name), int(parent), environment


class Cluster:
    """Folder, configuration and the processes that this object started."""

    def __init__(self, folder, nodes=4, threads=2, memory_mb=2000, max_array=1001, more=""):
        self.folder = os.path.abspath(folder)
        self.names = [f"node{n}" for n in range(1, nodes + 1)]
        self.config = os.path.join(self.folder, "slurm.conf")
        self.environment = {**os.environ, "SLURM_CONF": self.config}
        self.environment["PATH"] = os.environ.get("PATH", "") + ":/usr/sbin"
        self.children = []  # to be waited for when they have ended
        if not os.path.exists(self.config):
            self._configure(threads, memory_mb, max_array, more)

    def _configure(self, threads, memory_mb, max_array, more):
        for part in ("state", "log", "spool", "pids"):
            os.makedirs(os.path.join(self.folder, part), exist_ok=True)
        os.chmod(self.folder, 0o755)
        key = os.path.join(self.folder, "munge.key")
        with open(os.open(key, os.O_WRONLY | os.O_CREAT, 0o600), "wb") as file:
            file.write(os.urandom(1024))
        host = socket.gethostname().split(".")[0]
        ports = free_ports(1 + len(self.names))
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        nodes = "\n".join(
            f"NodeName={name} NodeAddr=127.0.0.1 NodeHostname={host} Port={port} CPUs={threads} "
            f"RealMemory={memory_mb} State=UNKNOWN"
            for name, port in zip(self.names, ports[1:])
        )
        with open(self.config, "w", encoding="utf-8") as file:
            file.write(
                CONFIG.format(
                    host=host,
                    controller_port=ports[0],
                    user=user,
                    folder=self.folder,
                    nodes=nodes,
                    max_array=max_array,
                    more=more,
                )
            )
        # Without this slurmd looks for a hierarchy that containers do not have.
        with open(os.path.join(self.folder, "cgroup.conf"), "w", encoding="utf-8") as file:
            file.write(
                "CgroupPlugin=cgroup/v1\nCgroupAutomount=no\nConstrainCores=no\nConstrainRAMSpace=no\n"
            )
        with open(os.path.join(self.folder, "names.json"), "w", encoding="utf-8") as file:
            json.dump(self.names, file)

    @classmethod
    def of(cls, folder):
        with open(os.path.join(folder, "names.json"), encoding="utf-8") as file:
            return cls(folder, len(json.load(file)))

    def _mark(self, name):
        """A variable of the environment that a part's processes hand on, and its value."""
        return "DRTV_CLUSTER_PART", f"{self.folder}/{name}"

    def _start(self, name, *command):
        os.makedirs(os.path.join(self.folder, "spool", name), exist_ok=True)
        with open(os.path.join(self.folder, "log", name + ".out"), "ab") as log:
            started = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
                env={**self.environment, **dict([self._mark(name)])},
            )
        self.children.append(started)

    def members(self, name):
        """The processes of a part, with all that they started: nobody else carries the mark."""
        mark = "=".join(self._mark(name)).encode()
        found = set()
        table = list(processes())
        for pid, _, environment in table:
            if mark in environment:
                found.add(pid)
        grown = True
        while grown:
            grown = False
            for pid, parent, _ in table:
                if parent in found and pid not in found:
                    found.add(pid)
                    grown = True
        return found

    def kill(self, name, how=signal.SIGKILL):
        """With SIGKILL all of a node's processes die, its tasks too."""
        deadline = time.monotonic() + PATIENCE_S
        while found := self.members(name):
            for child in self.children:
                child.poll()
            for pid in found:
                try:
                    os.kill(pid, how)
                except ProcessLookupError:
                    pass
            if time.monotonic() > deadline:
                raise AssertionError(f"{name} does not end")
            time.sleep(0.05)

    def start(self, name):
        if name == "munge":
            base = os.path.join(self.folder, "munge")
            self._start(
                name,
                "munged",
                "--foreground",
                "--force",
                "--num-threads=4",
                f"--key-file={base}.key",
                f"--socket={base}.socket",
                f"--pid-file={base}.pid",
                f"--log-file={base}.log",
                f"--seed-file={base}.seed",
            )
        elif name == "controller":
            self._start(name, "slurmctld", "-D", "-f", self.config)
        else:
            self._start(name, "slurmd", "-D", "-N", name, "-f", self.config)

    def run(self, *command):
        return subprocess.run(command, capture_output=True, text=True, check=False, env=self.environment)

    def _wait(self, condition, what):
        deadline = time.monotonic() + PATIENCE_S
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"{what} did not come up; see {self.folder}/log")
            time.sleep(0.1)

    def wait_for_controller(self):
        self._wait(lambda: self.run("scontrol", "ping").returncode == 0, "slurmctld")

    def states(self):
        rows = self.run("sinfo", "-h", "-N", "-o", "%N %T").stdout.split("\n")
        return dict(row.split() for row in rows if row)

    def up(self):
        self.start("munge")
        socket_path = os.path.join(self.folder, "munge.socket")
        self._wait(lambda: self.run("munge", "-n", "-S", socket_path).returncode == 0, "munged")
        self.start("controller")
        for name in self.names:
            self.start(name)
        self.wait_for_controller()
        alive = ("idle", "mixed", "allocated")
        self._wait(lambda: all(self.states().get(name) in alive for name in self.names), "a node")
        return self

    def down(self):
        for name in (*self.names, "controller", "munge"):
            self.kill(name)
        for child in self.children:
            child.wait()

    def __enter__(self):
        try:
            return self.up()
        except BaseException:
            self.down()
            raise

    def __exit__(self, *_):
        self.down()


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(dest="command", required=True)
    up = commands.add_parser("up")
    up.add_argument("folder")
    up.add_argument("--nodes", type=int, default=4)
    up.add_argument("--threads", type=int, default=2)
    for name in ("kill", "start"):
        one = commands.add_parser(name)
        one.add_argument("folder")
        one.add_argument("part", help="node1, node2, ... or controller")
    commands.add_parser("down").add_argument("folder")
    arguments = parser.parse_args()
    if missing := missing_programs():
        sys.exit(f"cluster.py: there is no {missing[0]}: deploy/install_packages.sh --tests brings it")
    if arguments.command == "up":
        cluster = Cluster(arguments.folder, arguments.nodes, arguments.threads).up()
        print(f"export SLURM_CONF={cluster.config}")
        return
    cluster = Cluster.of(arguments.folder)
    if arguments.command == "down":
        cluster.down()
    elif arguments.command == "kill":
        cluster.kill(arguments.part)
    else:
        cluster.start(arguments.part)


if __name__ == "__main__":
    main()
