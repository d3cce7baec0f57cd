#!/usr/bin/env python3
"""The rooms of the code and the arrows between them: fails when a file includes or names what its room may not, when a
link line does, when two rooms have a type of one name, and when README's table of rooms says otherwise.

The table below is the one in README; docs/design.md, section 5, gives the reasons. `--self-test` plants what is
forbidden and checks that each is found; `--readme` prints README's last column.
"""
import os
import re
import sys
import tempfile

# Library -> its headers, its names in code, its CMake targets.
LIBRARIES = {
    "zstd": (r"zstd\.h", r"ZSTD_\w+", {"zstd::libzstd_shared", "${drtv_zstd}"}),
    "CLI11": (r"CLI/", r"CLI::", {"CLI11::CLI11"}),
    "nlohmann_json": (r"nlohmann/", r"nlohmann::", {"nlohmann_json::nlohmann_json"}),
    "stb": (r"stb/", r"stbiw?_\w+|stb_\w+", set()),
    "GLM": (r"glm/", r"glm::", {"glm::glm"}),
    "CGAL": (r"CGAL/", r"CGAL::", {"CGAL::CGAL"}),
    "tinygltf": (r"tiny_gltf\.h", r"tinygltf::", {"TinyGLTF::TinyGLTF"}),
    "Embree": (r"embree3/", r"rtc[A-Z]\w+|RTC[A-Z]\w+", {"embree"}),
    "TBB": (r"tbb/", r"tbb::", {"TBB::tbb"}),
    "OpenSSL": (r"openssl/", r"EVP_\w+", {"OpenSSL::Crypto"}),
    "SQLite": (r"(sqlite3\.h|SQLiteCpp/)", r"SQLite::|sqlite3_\w+", {"SQLiteCpp", "SQLite::SQLite3"}),
    "protobuf": (r"google/protobuf/", r"google::protobuf::", {"protobuf::libprotobuf"}),
    "gRPC": (r"(grpcpp|grpc)/", r"grpc::", {"gRPC::grpc++", "gRPC::grpc++_reflection"}),
    "spdlog": (r"spdlog/", r"spdlog::", {"spdlog::spdlog"}),
    "fmt": (r"fmt/", r"fmt::", {"fmt::fmt"}),
    "tl-expected": (r"tl/expected", r"tl::", {"tl::expected"}),
    "threads": (r"(?!)", r"(?!)", {"Threads::Threads"}),
}
# Small, and without consequence: README names them in a sentence, not in the table.
EVERYDAY = {"spdlog", "fmt", "tl-expected", "threads"}

# Room (the longest prefix of a path wins) -> what it may use: rooms besides itself, libraries, and single public
# headers of rooms to which it has no arrow.
ROOMS = {
    "format": "zstd",
    "format/runtime": "format",
    "format/light": "format/runtime nlohmann_json tl-expected",
    "format/spelling": "",
    "format/cli": "format/spelling drtv/version.h CLI11 nlohmann_json tl-expected",
    "format/folder": "format/cli nlohmann_json OpenSSL tl-expected",
    "format/image": "format/folder format/cli drtv/conventions.h stb tl-expected",
    "format/kit": "format/folder format/cli format/light format/runtime format CLI11 tl-expected",
    "format/tool": "format/kit format/image format/folder format/cli format/runtime format CLI11 nlohmann_json tl-expected threads",
    "placement": "drtv/conventions.h GLM CGAL fmt tl-expected",
    "proto": "gRPC protobuf",
    "settings": "fmt tl-expected",
    "map_files": "nlohmann_json fmt tl-expected",
    "settings/message": "settings proto protobuf tl-expected",
    "bakerd/map": "map_files format/spelling drtv/conventions.h GLM tinygltf stb nlohmann_json OpenSSL fmt tl-expected",
    "bakerd/trace": "bakerd/map placement GLM Embree fmt tl-expected",
    "bakerd/bake": "bakerd/trace bakerd/map placement settings format GLM TBB fmt tl-expected",
    "bakerd/reuse": "bakerd/bake bakerd/trace bakerd/map placement settings format GLM TBB zstd fmt tl-expected",
    "bakerd/store": "bakerd/map map_files nlohmann_json fmt tl-expected",
    "bakerd/worker": "bakerd/reuse bakerd/bake bakerd/trace bakerd/store bakerd/map settings TBB nlohmann_json spdlog fmt tl-expected",
    "bakerd/executor": "bakerd/worker bakerd/store spdlog fmt tl-expected",
    "bakerd/farm": "bakerd/executor bakerd/worker bakerd/reuse bakerd/bake bakerd/store bakerd/map settings SQLite spdlog fmt tl-expected",
    "bakerd/service": "bakerd/farm bakerd/executor bakerd/reuse bakerd/store bakerd/map map_files drtv/version.h settings/message settings proto gRPC protobuf fmt tl-expected",
    "bakerd/picture": "bakerd/bake bakerd/trace bakerd/map map_files format/kit format/image format/folder format/cli format/light format/runtime format GLM TBB CLI11 fmt tl-expected",
    # main wires the rooms together and asks trace whether this CPU will do.
    "bakerd": "bakerd/service bakerd/farm bakerd/executor bakerd/store bakerd/bake bakerd/picture bakerd/worker bakerd/trace format/cli CLI11 spdlog fmt tl-expected",
    "client": "drtv/version.h settings/message settings map_files proto format/cli format/folder format/image format/spelling CLI11 nlohmann_json gRPC fmt tl-expected",
}
# A game may link these, so nothing in them may rest on a room under another licence.
MIT_ROOMS = ("format", "proto")
MIT_FOLDERS = (*MIT_ROOMS, "examples")

# What a room's types stand in, besides drtv itself: naming it is using the room.
NAMESPACES = {
    "v1": "proto",
    **{
        room.split("/")[-1]: room
        for room in ROOMS
        if room not in ("format", "proto", "bakerd", "settings/message")
    },
}
del NAMESPACES["runtime"], NAMESPACES["light"]  # theirs is drtv, as format's
# std::map:: is no room of ours, and neither is another's nested name.
NAMED_SPACE = re.compile(rf"(?<![\w:])(?:drtv::)?({'|'.join(sorted(NAMESPACES, key=len, reverse=True))})::")

SOURCES = (".h", ".cpp", ".c", ".py", ".proto", ".shader", ".sh")
FORBIDDEN_NAMES = {"util", "utils", "common", "core", "helper", "helpers", "manager"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]', re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class|union) (\w+)(?![\w:]| \w)[^;\n]*(?:\{|$)", re.MULTILINE)
# Public headers of format/ are included as <drtv/...>; which room one belongs to is looked up.
PUBLIC_ROOTS = {
    "format/include": "format",
    "format/runtime/include": "format/runtime",
    "format/light/include": "format/light",
}


def uses(room):
    return set(ROOMS[room].split())


def room_of(path):
    best = ""
    for room in ROOMS:
        if (path == room or path.startswith(room + "/")) and len(room) > len(best):
            best = room
    return best


def files_below(root, endings, tops=tuple(sorted({name.split("/")[0] for name in ROOMS}))):
    for top in tops:
        for folder, folders, names in os.walk(os.path.join(root, top)):
            folders[:] = [name for name in folders if name != "node_modules"]
            for name in sorted(names):
                if name.endswith(endings):
                    yield os.path.relpath(os.path.join(folder, name), root)


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def without_comments_and_texts(code):
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', " ", code, flags=re.DOTALL)


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
        if path.startswith("format/") and room_of("format/" + header) != "format":
            return room_of("format/" + header)
        return room_of(header) or None
    return None


def needs_of(root, path, text):
    """What a file uses: how it says so, and what allows it, first of all the room or library itself."""
    for quote, header in INCLUDE.findall(text):
        target = target_room(root, path, quote, header)
        if target is not None:
            yield f"includes {header}", (target, header)
            continue
        for library, (headers, _, _) in LIBRARIES.items():
            if re.match(headers, header):
                yield f"includes {header}", (library,)
    code = without_comments_and_texts(text)
    for name in sorted(set(NAMED_SPACE.findall(code))):
        yield f"names {name}::", (NAMESPACES[name],)
    for library, (_, names, _) in LIBRARIES.items():
        if found := re.search(rf"(?<![\w:])(?:{names})", code):
            yield f"names {found.group(0)}", (library,)


def needs(root):
    """(path, room, how, what allows it) of all files."""
    return [
        (path, room_of(path), *need)
        for path in files_below(root, (".h", ".cpp"))
        for need in needs_of(root, path, read(root, path))
    ]


def check_needs(found):
    for path, room, how, allowing in found:
        if room in allowing or uses(room) & set(allowing):
            continue
        used = allowing[0]
        lacks = (
            f"{room} may not use {used}" if used in LIBRARIES else f"there is no arrow from {room} to {used}"
        )
        yield f"{path}: {how}, and {lacks}"


def check_unused(found):
    """An arrow that no file needs is none. Threads have no header here, and the contract's code is generated."""
    needed = {room: {"threads"} for room in ROOMS}
    needed["proto"] |= {"gRPC", "protobuf"}
    for _, room, _, allowing in found:
        needed[room].update(allowing)
    for room, names in needed.items():
        for used in sorted(uses(room) - names):
            yield f"tests/arrows.py: {room} may use {used}, and no file of it does"


def rooms_of_targets(root):
    rooms = {}
    for path in files_below(root, ("CMakeLists.txt",)):
        for name in re.findall(r"^\s*add_(?:library|executable)\((\w+)", read(root, path), re.MULTILINE):
            rooms[name] = room_of(os.path.dirname(path) + "/")
    for name in rooms:
        if name in ("drtv_runtime", "drtv_c"):
            rooms[name] = "format/runtime"
        if name == "settings_message":
            rooms[name] = "settings/message"
    return rooms


def check_links(root):
    rooms = rooms_of_targets(root)
    targets = {target: library for library, (_, _, names) in LIBRARIES.items() for target in names}
    for path in files_below(root, ("CMakeLists.txt",)):
        for line in re.findall(r"target_link_libraries\(([^)]*)\)", read(root, path)):
            target, *linked = line.split()
            room = rooms.get(target, room_of(path))
            for word in linked:
                name = re.sub(r"^\$<BUILD_INTERFACE:(.*)>$", r"\1", word).replace("drtv::", "drtv_")
                if name in ("PUBLIC", "PRIVATE", "INTERFACE", "drtv_flags"):
                    continue
                used = rooms.get(name) or targets.get(name)
                if name == "drtv_conventions":
                    used = room if {"drtv/conventions.h", "drtv/version.h"} & uses(room) else "format"
                if used is None:
                    yield f"{path}: {target} links {name}, of which this test knows nothing"
                elif used != room and used not in uses(room):
                    yield f"{path}: {target} links {name}, and there is no arrow from {room} to {used}"


def check_types(root):
    """A name means one thing: no two headers of the project have a type of one name."""
    where = {}
    for path in files_below(root, (".h",)):
        for name in sorted(set(TYPE.findall(without_comments_and_texts(read(root, path))))):
            if name in where:
                yield f"{path}: the type {name} stands in {where[name]} as well"
            where.setdefault(name, path)


def check_licences(root):
    """The LICENSE nearest above a file is the file's: it says what README says, and no file says otherwise."""
    said = {
        "MIT": r"MIT License|SPDX-License-Identifier: MIT",
        "GPL": r"GNU GENERAL PUBLIC LICENSE|SPDX-License-Identifier: GPL",
    }
    for folder in ("", *MIT_FOLDERS):
        licence = "MIT" if folder else "GPL"
        path = os.path.join(folder, "LICENSE")
        if not re.search(said[licence], read(root, path)):
            yield f"{path} is not the {licence}'s"
    for path in [
        *files_below(root, SOURCES),
        *files_below(root, SOURCES, ("examples", "tests", "deploy", "docs")),
    ]:
        licence = "MIT" if path.split("/")[0] in MIT_FOLDERS else "GPL"
        other = "GPL" if licence == "MIT" else "MIT"
        if path != "tests/arrows.py" and re.search(said[other], read(root, path)):
            yield f"{path} says that it is under the {other}, its folder is under the {licence}"
    readme = set(re.findall(r"`([\w/]+)/`", read(root, "README.md").split("## Licences")[1].split("MIT")[0]))
    if readme != set(MIT_FOLDERS):
        yield f"README.md: {sorted(MIT_FOLDERS)} are under the MIT licence, it says {sorted(readme)}"
    for room in ROOMS:
        if room.split("/")[0] not in MIT_ROOMS:
            continue
        for used in uses(room) & set(ROOMS):
            if used.split("/")[0] not in MIT_ROOMS:
                yield f"{room} is under the MIT licence and may not use {used}, which is not"


def in_readme(room):
    """README's last column: arrows, then libraries."""
    used = [name for name in ROOMS[room].split() if name not in EVERYDAY]
    return ", ".join(name if name in LIBRARIES else f"`{name}`" for name in used) or "-"


def check_readme(root):
    rows = dict(re.findall(r"^\| `([\w/]+)/` \|.*\| ([^|]+) \|$", read(root, "README.md"), re.MULTILINE))
    for room in ROOMS:
        if room != "bakerd" and rows.get(room) != in_readme(room):
            yield f"README.md: the row of `{room}/` must end with: {in_readme(room)}, not {rows.get(room)}"
    yield from (f"README.md: there is no room `{room}/`" for room in rows if room not in ROOMS)


def check_code(root, found):
    for path in files_below(root, (".h", ".cpp")):
        parts = re.split(r"[/_.]", path)
        yield from (
            f"{path}: no room or file is called '{part}'" for part in parts if part in FORBIDDEN_NAMES
        )
    yield from check_needs(found)
    yield from check_links(root)
    yield from check_types(root)


PLANTED = [
    ("format/src/planted.cpp", '#include "bakerd/map/map.h"\n', "no arrow from format to bakerd/map"),
    ("format/src/planted.cpp", "#include <glm/vec3.hpp>\n", "glm/vec3.hpp, and format may not use GLM"),
    ("placement/planted.cpp", "#include <embree3/rtcore.h>\n", "placement may not use Embree"),
    ("bakerd/trace/planted.cpp", "#  include <CGAL/Surface_mesh.h>\n", "bakerd/trace may not use CGAL"),
    ("bakerd/map/planted.h", '#include "bakerd/trace/scene.h"\n', "no arrow from bakerd/map to bakerd/trace"),
    ("bakerd/farm/planted.cpp", "#include <grpcpp/grpcpp.h>\n", "bakerd/farm may not use gRPC"),
    ("bakerd/farm/planted.cpp", '#include "drtv/v1/job.pb.h"\n', "no arrow from bakerd/farm to proto"),
    ("client/planted.cpp", '#include "bakerd/farm/farm.h"\n', "no arrow from client to bakerd/farm"),
    ("client/planted.cpp", "#include <drtv/sector.h>\n", "no arrow from client to format"),
    ("client/planted.cpp", "#include <drtv/conventions.h>\n", "no arrow from client to format"),
    ("client/planted.cpp", '#include "format/kit/png.h"\n', "no arrow from client to format/kit"),
    ("placement/planted.cpp", "#include <drtv/sector.h>\n", "no arrow from placement to format"),
    ("format/cli/planted.cpp", '#include "kit/png.h"\n', "no arrow from format/cli to format/kit"),
    ("bakerd/bake/string_util.h", "", "called 'util'"),
    # Names that come through another header.
    ("bakerd/farm/planted.cpp", "trace::Device device;\n", "names trace::, and there is no arrow from bakerd/farm"),
    ("bakerd/service/planted.h", "void f(const drtv::bake::World&);\n", "names bake::"),
    ("bakerd/farm/planted.cpp", "grpc::Status status;\n", "names grpc::, and bakerd/farm may not use gRPC"),
    ("bakerd/bake/planted.cpp", "auto scene = rtcNewScene(device);\n", "names rtcNewScene"),
    ("client/planted.cpp", "v1::Job job; cli::warn(\"farm::Farm\");  // farm::Farm\nfarm::Farm x;\n", "names farm::"),
    ("bakerd/farm/CMakeLists.txt", "target_link_libraries(x PUBLIC drtv_flags\n  PRIVATE embree)\n", "links embree"),
    ("client/CMakeLists.txt", "target_link_libraries(bake PRIVATE mystery)\n", "links mystery, of which"),
    ("placement/CMakeLists.txt", "add_library(p)\ntarget_link_libraries(p PRIVATE fmt::fmt TBB::tbb)\n", "links TBB::tbb"),
]  # fmt: skip
PLANTED_TYPES = {"bakerd/map/a.h": "struct Region {\n};\n", "client/b.h": "class Region\n    : Base {};\n"}


def found_in(files):
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            os.makedirs(os.path.join(root, os.path.dirname(path)), exist_ok=True)
            with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                file.write(text)
        return list(check_code(root, needs(root)))


def self_test():
    failures = 0
    cases = [({path: text}, expected) for path, text, expected in PLANTED]
    cases.append((PLANTED_TYPES, "the type Region stands in bakerd/map/a.h as well"))
    for files, expected in cases:
        found = found_in(files)
        if len(found) != 1 or expected not in found[0]:
            print(f"planted {files}: found {found}, expected one with '{expected}'")
            failures += 1
    harmless = "std::map<int, int>::iterator a;\nstore::Result<int> b;\nstruct Region;\n"
    failures += len(found_in({"bakerd/farm/a.h": harmless, "bakerd/map/b.h": "struct Region;\n"}))
    used = [
        ("bakerd/store/a.cpp", "bakerd/store", "names x", (name,))
        for name in ("bakerd/map", "fmt", "tl-expected")
    ]
    unused = [error for error in check_unused(used) if "bakerd/store may" in error]
    if unused != [
        f"tests/arrows.py: bakerd/store may use {name}, and no file of it does"
        for name in ("map_files", "nlohmann_json")
    ]:
        print(f"unused arrows: found {unused}")
        failures += 1
    print(f"{len(cases) + 2 - failures} passed, {failures} failed")
    return failures == 0


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    if "--self-test" in sys.argv:
        sys.exit(0 if self_test() else 1)
    if "--readme" in sys.argv:
        for room in ROOMS:
            print(f"{room}: {in_readme(room)}")
        return
    found = needs(root)
    errors = [*check_code(root, found), *check_unused(found), *check_licences(root), *check_readme(root)]
    for error in errors:
        print(error)
    sys.exit(1 if errors else 0)


main()
