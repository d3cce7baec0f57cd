#!/usr/bin/env python3
"""Makes one pair of files of all that a game compiles: drtv_runtime.h and drtv_runtime.cpp, which read raw sector files
and relight them. Usage: amalgamate.py OUT_FOLDER

The pair needs C++20 and its standard library, no zstd, no exceptions, no RTTI; it carries the licence.
"""
import os
import re
import sys

FORMAT = os.path.dirname(os.path.abspath(__file__))
INCLUDE = [os.path.join(FORMAT, "include"), os.path.join(FORMAT, "runtime", "include")]
LOCAL = re.compile(r'^#include\s+(?:"([^"]+)"|<(drtv/[^>]+)>).*\n', re.MULTILINE)
SYSTEM = re.compile(r"^#include\s+<([^>]+)>.*\n", re.MULTILINE)

PUBLIC = [
    "version",
    "ambient",
    "conventions",
    "day",
    "light",
    "local_lights",
    "read",
    "relight",
    "relit_probes",
    "sector",
    "sector_set",
    "sky_tile",
    "tile_texture",
    "view",
    "volume",
]


def opening_sources():
    """Of format/src: what opens a raw file, as CMakeLists.txt has it. All of format/runtime/src comes with it but for the C
    face, which is libdrtv's."""
    with open(os.path.join(FORMAT, "CMakeLists.txt"), encoding="utf-8") as file:
        return re.search(r"set\(opening_sources\s+([^)]*)\)", file.read()).group(1).split()


class Pair:
    def __init__(self):
        self.done = set()  # files that stand in the pair already

    def path_of(self, name, beside):
        for folder in [beside, *INCLUDE]:
            path = os.path.join(folder, name)
            if os.path.exists(path):
                return os.path.abspath(path)
        raise SystemExit(f"amalgamate.py: {name}, included in {beside}, is not there")

    def text_of(self, path):
        """A file with what it includes of ours before it, each once; empty where it stood already."""
        if path in self.done:
            return ""
        self.done.add(path)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        text = text.replace("#pragma once\n", "")
        before = "".join(
            self.text_of(self.path_of(own or public, os.path.dirname(path)))
            for own, public in LOCAL.findall(text)
        )
        name = os.path.relpath(path, FORMAT)
        return f"{before}\n// ---- {name}\n\n{LOCAL.sub('', text).strip()}\n"


def with_system_includes_first(text):
    # Includes under conditions stay where they are.
    free = [name for name in SYSTEM.findall(text) if not name.endswith(".h")]
    names = sorted(set(free))
    text = re.sub(r"^#include\s+<[^>.]+>.*\n", "", text, flags=re.MULTILINE)
    return "".join(f"#include <{name}>\n" for name in names) + re.sub(r"\n{3,}", "\n\n", text)


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    with open(os.path.join(FORMAT, "LICENSE"), encoding="utf-8") as file:
        licence = "".join(f"// {line}".rstrip() + "\n" for line in file.read().splitlines())
    pair = Pair()
    header = "".join(pair.text_of(pair.path_of(f"drtv/{name}.h", FORMAT)) for name in PUBLIC)
    runtime = os.path.join(FORMAT, "runtime", "src")
    sources = [os.path.join(FORMAT, name) for name in opening_sources()]
    sources += [
        os.path.join(runtime, name)
        for name in sorted(os.listdir(runtime))
        if name.endswith(".cpp") and not name.startswith("c_api")
    ]
    body = "".join(pair.text_of(path) for path in sources)
    absent = "//\n// Raw files only: read_sector and unpack_sector are declared below, and not in the pair. `drtv strip` makes raw files.\n"
    made = "// Made by amalgamate.py of drtv's format/: change it there.\n//\n"
    os.makedirs(sys.argv[1], exist_ok=True)
    with open(os.path.join(sys.argv[1], "drtv_runtime.h"), "w", encoding="utf-8") as file:
        file.write(made + licence + absent + "#pragma once\n\n" + with_system_includes_first(header))
    # Products and sums are rounded one by one, also where a compiler may fuse them.
    exact = '#if defined(__clang__)\n#pragma STDC FP_CONTRACT OFF\n#elif defined(__GNUC__)\n#pragma GCC optimize("fp-contract=off")\n#endif\n'
    with open(os.path.join(sys.argv[1], "drtv_runtime.cpp"), "w", encoding="utf-8") as file:
        file.write(
            made + licence + exact + '\n#include "drtv_runtime.h"\n\n' + with_system_includes_first(body)
        )


if __name__ == "__main__":
    main()
