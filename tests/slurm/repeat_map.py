#!/usr/bin/python3
"""A large map out of a small one: N x N copies of a GLB, side by side, each in a file of its own.

    repeat_map.py MAP.glb SIDE_METRES N FOLDER"""
import json
import os
import struct
import sys

MAGIC, JSON_CHUNK = 0x46546C67, 0x4E4F534A


def read_glb(path):
    """The document, and the chunks that follow it."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version, _ = struct.unpack_from("<III", data)
    size, kind = struct.unpack_from("<II", data, 12)
    if (magic, version, kind) != (MAGIC, 2, JSON_CHUNK):
        sys.exit(f"{path} is no GLB of glTF 2.0")
    return json.loads(data[20 : 20 + size]), data[20 + size :]


def write_glb(path, document, chunks):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<III", MAGIC, 2, 20 + len(text) + len(chunks)))
        file.write(struct.pack("<II", len(text), JSON_CHUNK) + text + chunks)


def moved(document, prefix, east, south):
    """A copy elsewhere, whose nodes have names of their own: interiors refer to probes by name."""
    copy = json.loads(json.dumps(document))
    for node in copy["nodes"]:
        if "name" in node:
            node["name"] = prefix + node["name"]
        if "bake_probe" in node.get("extras", {}):
            node["extras"]["bake_probe"] = prefix + node["extras"]["bake_probe"]
    scene = copy["scenes"][copy.get("scene", 0)]
    copy["nodes"].append(
        {"name": prefix + "root", "translation": [east, 0, south], "children": scene["nodes"]}
    )
    scene["nodes"] = [len(copy["nodes"]) - 1]
    return copy


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    path, side, count, folder = sys.argv[1], float(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
    document, chunks = read_glb(path)
    os.makedirs(folder, exist_ok=True)
    for j in range(count):
        for i in range(count):
            prefix = f"{i}_{j}_"
            write_glb(
                os.path.join(folder, f"{prefix}{os.path.basename(path)}"),
                moved(document, prefix, i * side, -j * side),
                chunks,
            )


if __name__ == "__main__":
    main()
