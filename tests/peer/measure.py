"""The two bakers: drtv's daemon, and Cycles in a Blender of its own."""
import contextlib
import json
import math
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "e2e"))
from farm_fixture import Farm  # noqa: E402

# docs/design.md, section 1 and section 2; format/SPEC.md.
BASIS = [
    (-0.408248, -0.707107, 0.577350),
    (-0.408248, 0.707107, 0.577350),
    (0.816497, 0.0, 0.577350),
    (0.0, 0.0, -1.0),
]
OPEN_SKY = [(1 + b[2]) / 2 for b in BASIS]  # E/pi around b under a whole sky of radiance 1
SH_CONSTANT, SH_LINEAR = math.sqrt(4 * math.pi), math.sqrt(4 * math.pi / 3)
# Four skies of radiance 1 + axis . w, and their SH. Never negative, and they span what four SH numbers can say.
SKIES = {
    "1": ((0, 0, 0), (SH_CONSTANT, 0, 0, 0)),
    "1+y": ((0, 1, 0), (SH_CONSTANT, SH_LINEAR, 0, 0)),
    "1+z": ((0, 0, 1), (SH_CONSTANT, 0, SH_LINEAR, 0)),
    "1+x": ((1, 0, 0), (SH_CONSTANT, 0, 0, SH_LINEAR)),
}


@contextlib.contextmanager
def open_farm(options):
    """A daemon and a scratch folder, gone at the end."""
    if shutil.which(options.blender) is None:
        sys.exit(
            f"{options.blender}: not found; in Debian it is `apt-get install --no-install-recommends blender python3-numpy`"
        )
    farm = Farm(options.bin)
    try:
        yield farm, farm.daemon("data", "--threads", str(options.threads))
    finally:
        farm.close()


def write_lattice(path, text):
    """A glTF of nothing but hand-placed probes."""
    *corners, nx, ny, nz = (float(word) for word in text.split(","))
    low, high, counts = corners[:3], corners[3:], [int(nx), int(ny), int(nz)]

    def at(axis, n):
        return low[axis] + (high[axis] - low[axis]) * (n / (counts[axis] - 1) if counts[axis] > 1 else 0.5)

    nodes = [
        {
            "name": f"probe_{i}_{j}_{k}",
            "translation": [at(0, i), at(2, k), -at(1, j)],
            "extras": {"bake_role": "probe"},
        }
        for i in range(counts[0])
        for j in range(counts[1])
        for k in range(counts[2])
    ]
    with open(path, "w", encoding="utf-8") as file:
        json.dump(
            {
                "asset": {"version": "2.0"},
                "scene": 0,
                "scenes": [{"nodes": list(range(len(nodes)))}],
                "nodes": nodes,
            },
            file,
        )


def bake(farm, daemon, options, rays):
    """drtv's probes, decoded, in the order of the files."""
    folder, inputs = farm.path(f"rays_{rays}"), [options.map]
    if options.lattice:
        inputs.append(farm.path("lattice.gltf"))
        write_lattice(inputs[1], options.lattice)
    settings = [f"rays={rays}", f"bounces={options.bounces}", f"reach={options.reach}", *options.set]
    done = farm.bake(
        daemon,
        "submit",
        *inputs,
        "--wait",
        "--pull",
        folder,
        *(["--region", options.region] if options.region else []),
        *(word for setting in settings for word in ("--set", setting)),
        timeout=3600,
    )
    if done.returncode != 0:
        sys.exit(f"bake: {done.stderr.strip()}")
    probes = []
    for name in sorted(name for name in os.listdir(folder) if name.endswith(".drtv")):
        probes += json.loads(farm.run("drtv", "dump", os.path.join(folder, name), "--json").stdout)["probes"]
    return [p for p in probes if p["kind"] == "manual"] if options.lattice else probes


def evenly(items, count):
    return items if len(items) <= count else [items[n * len(items) // count] for n in range(count)]


def run_cycles(farm, options, positions, passes, sky_sampling="NONE"):
    """cycles_bake.py's answer. passes: name, light (DIRECT, INDIRECT), axis, samples."""
    request_path, answer_path = farm.path("request.json"), farm.path("answer.json")
    with open(request_path, "w", encoding="utf-8") as file:
        json.dump(
            {
                "map": os.path.abspath(options.map),
                "probes": positions,
                "directions": BASIS,
                "bounces": options.bounces,
                "threads": options.threads,
                "replicas": options.replicas,
                "sky_sampling": sky_sampling,
                "passes": passes,
            },
            file,
        )
    # Blender's Python looks for its library beside the first python3 of PATH; it must find Debian's, which has numpy.
    done = subprocess.run(
        [
            shutil.which(options.blender),
            "-b",
            "--factory-startup",
            "-t",
            str(options.threads),
            "--python-exit-code",
            "1",
            "-P",
            os.path.join(HERE, "cycles_bake.py"),
            "--",
            request_path,
            answer_path,
        ],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PATH": "/usr/bin:/bin"},
    )
    if done.returncode != 0:
        sys.exit("blender: " + (done.stdout + done.stderr)[-2000:])
    with open(answer_path, encoding="utf-8") as file:
        answer = json.load(file)
    if answer["farthest_m"] >= options.reach:
        sys.exit(
            f"the map reaches {answer['farthest_m']:.0f} m from a probe: drtv would take what lies beyond --reach {options.reach:g} for sky"
        )
    return answer
