#!/usr/bin/env python3
"""The rooms of the code and the arrows between them: fails when a file includes what its room may not.

The table below is the one in README; DESIGN section 5 gives the reasons. `--self-test` plants forbidden includes
and checks that each is found.
"""
import os
import re
import sys
import tempfile

# Room (longest prefix wins) -> rooms whose headers it may include, besides its own.
ARROWS = {
    "format": set(),
    "format/runtime": {"format"},
    "format/light": {"format", "format/runtime"},
    "format/kit": {"format", "format/runtime", "format/light"},
    "format/tool": {"format", "format/runtime", "format/light", "format/kit"},
    "placement": set(),
    "bakerd/map": set(),
    "bakerd/trace": {"bakerd/map", "placement"},
    "bakerd/bake": {"bakerd/trace", "bakerd/map", "placement", "format"},
    "bakerd/reuse": {"bakerd/bake", "bakerd/trace", "bakerd/map", "placement", "format"},
    "bakerd/store": {"bakerd/map"},
    "bakerd/worker": {
        "bakerd/store",
        "bakerd/reuse",
        "bakerd/bake",
        "bakerd/trace",
        "bakerd/map",
        "format",
    },
    "bakerd/farm": {"bakerd/worker", "bakerd/store", "bakerd/reuse", "bakerd/bake", "bakerd/map"},
    "bakerd/service": {"bakerd/farm", "bakerd/worker", "bakerd/store", "bakerd/reuse", "bakerd/map", "proto"},
    "bakerd/picture": {
        "bakerd/bake",
        "bakerd/trace",
        "bakerd/map",
        "format",
        "format/runtime",
        "format/light",
        "format/kit",
    },
    # main wires the rooms together and asks trace whether this CPU will do.
    "bakerd": {
        "bakerd/farm",
        "bakerd/picture",
        "bakerd/service",
        "format/kit",
        "bakerd/trace",
        "bakerd/worker",
    },
    "client": {"proto"},
}

# Single public headers -> rooms that may include them without an arrow to their room.
OPEN_HEADERS = {"drtv/conventions.h": {"placement", "bakerd/map"}}

# Foreign headers -> the only rooms that may include them.
FOREIGN = {
    r"tiny_gltf\.h": {"bakerd/map"},
    r"stb/": {"bakerd/map", "bakerd/picture", "client", "format/kit"},
    r"embree3/": {"bakerd/trace"},
    r"CGAL/": {"placement"},
    r"glm/": {"placement", "bakerd/map", "bakerd/trace", "bakerd/bake", "bakerd/reuse", "bakerd/picture"},
    r"tbb/": {"bakerd/bake", "bakerd/reuse", "bakerd/worker", "bakerd/picture"},
    r"zstd\.h": {"format", "bakerd/reuse"},
    r"(sqlite3\.h|SQLiteCpp/)": {"bakerd/farm"},
    r"(grpcpp|grpc)/": {"bakerd/service", "client"},
    r"google/protobuf/": {"bakerd/service"},
    r"nlohmann/": {"format/light", "format/tool", "bakerd/map", "bakerd/store", "bakerd/worker", "client"},
    r"openssl/": {"bakerd/map", "client"},
    r"CLI/": {"bakerd", "bakerd/picture", "client", "format/kit", "format/tool"},
    r"spdlog/": {"bakerd", "bakerd/worker", "bakerd/farm", "bakerd/service"},
    r"fmt/": {
        "bakerd",
        "placement",
        "bakerd/map",
        "bakerd/trace",
        "bakerd/bake",
        "bakerd/reuse",
        "bakerd/store",
        "bakerd/worker",
        "bakerd/farm",
        "bakerd/service",
        "bakerd/picture",
        "client",
    },
    r"tl/expected": {
        "placement",
        "bakerd/map",
        "bakerd/trace",
        "bakerd/bake",
        "bakerd/reuse",
        "bakerd/store",
        "bakerd/worker",
        "bakerd/farm",
        "bakerd/service",
        "bakerd/picture",
        "client",
    },
}

FORBIDDEN_NAMES = {"util", "utils", "common", "core", "helper", "helpers", "manager"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]', re.MULTILINE)
# Public headers of format/ and runtime are included as <drtv/...>; which room one belongs to is looked up.
PUBLIC_ROOTS = {
    "format/include": "format",
    "format/runtime/include": "format/runtime",
    "format/light/include": "format/light",
}


def room_of(path):
    best = ""
    for room in ARROWS:
        if (path == room or path.startswith(room + "/")) and len(room) > len(best):
            best = room
    return best


def source_files(root):
    for room in sorted({name.split("/")[0] for name in ARROWS}):
        for folder, _, names in os.walk(os.path.join(root, room)):
            for name in sorted(names):
                if name.endswith((".h", ".cpp")):
                    yield os.path.relpath(os.path.join(folder, name), root)


def target_room(root, path, quote, header):
    """Room of an included header of ours, or None for a foreign one."""
    if header.startswith("drtv/v1/"):
        return "proto"
    if header.startswith("drtv/"):
        for public, room in PUBLIC_ROOTS.items():
            if os.path.exists(os.path.join(root, public, header)):
                return room
        return "format"
    if quote == '"':
        beside = os.path.normpath(os.path.join(os.path.dirname(path), header))
        if os.path.exists(os.path.join(root, beside)):
            return room_of(beside)
        # format/ also builds alone: its parts name each other from there.
        if os.path.exists(os.path.join(root, "format", header)):
            return room_of("format/" + header)
        return room_of(header) or None
    return None


def check(root):
    errors = []
    for path in source_files(root):
        room = room_of(path)
        parts = re.split(r"[/_.]", path)
        errors += [f"{path}: no room or file is called '{part}'" for part in parts if part in FORBIDDEN_NAMES]
        with open(os.path.join(root, path), encoding="utf-8") as file:
            text = file.read()
        for quote, header in INCLUDE.findall(text):
            target = target_room(root, path, quote, header)
            if target is not None:
                is_open = room in OPEN_HEADERS.get(header, set())
                if target != room and target not in ARROWS[room] and not is_open:
                    errors.append(f"{path}: includes {header}, and there is no arrow from {room} to {target}")
                continue
            for pattern, rooms in FOREIGN.items():
                if re.match(pattern, header) and room not in rooms:
                    errors.append(
                        f"{path}: includes {header}, which only {', '.join(sorted(rooms)) or 'nobody'} may"
                    )
    return errors


PLANTED = [
    ("format/src/planted.cpp", '#include "bakerd/map/map.h"\n', "no arrow from format to bakerd/map"),
    ("format/src/planted.cpp", "#include <glm/vec3.hpp>\n", "glm/vec3.hpp, which only"),
    ("placement/planted.cpp", "#include <embree3/rtcore.h>\n", "embree3/rtcore.h, which only bakerd/trace"),
    (
        "bakerd/trace/planted.cpp",
        "#  include <CGAL/Surface_mesh.h>\n",
        "CGAL/Surface_mesh.h, which only placement",
    ),
    ("bakerd/map/planted.h", '#include "bakerd/trace/scene.h"\n', "no arrow from bakerd/map to bakerd/trace"),
    ("bakerd/farm/planted.cpp", "#include <grpcpp/grpcpp.h>\n", "grpcpp/grpcpp.h, which only"),
    ("bakerd/farm/planted.cpp", '#include "drtv/v1/job.pb.h"\n', "no arrow from bakerd/farm to proto"),
    ("client/planted.cpp", '#include "bakerd/farm/farm.h"\n', "no arrow from client to bakerd/farm"),
    ("client/planted.cpp", "#include <drtv/sector.h>\n", "no arrow from client to format"),
    ("client/planted.cpp", "#include <drtv/conventions.h>\n", "no arrow from client to format"),
    ("placement/planted.cpp", "#include <drtv/sector.h>\n", "no arrow from placement to format"),
    ("bakerd/bake/string_util.h", "", "called 'util'"),
]


def self_test():
    failures = 0
    for path, text, expected in PLANTED:
        with tempfile.TemporaryDirectory() as root:
            os.makedirs(os.path.join(root, os.path.dirname(path)))
            with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                file.write(text)
            found = check(root)
            if len(found) != 1 or expected not in found[0]:
                print(
                    f"planted {text.strip() or path} in {path}: found {found}, expected one with '{expected}'"
                )
                failures += 1
    print(f"{len(PLANTED) - failures} passed, {failures} failed")
    return failures == 0


def main():
    if "--self-test" in sys.argv:
        sys.exit(0 if self_test() else 1)
    errors = check(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    for error in errors:
        print(error)
    sys.exit(1 if errors else 0)


main()
