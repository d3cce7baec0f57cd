"""Maps of a few quads, and changes of them."""
import base64
import json
import os
import struct


def write_map(path, buffer_uri=None, **quads):
    """A glTF file with a node of that name for each quad: four corners in world axes, counter-clockwise seen from the front.
    With a uri the caller writes the buffer; the bytes are given."""
    data = b"".join(
        struct.pack("<3f", x, z, -y) for quad in quads.values() for x, y, z in quad
    ) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    vertices = {"buffer": 0, "byteOffset": 0, "byteLength": 48 * len(quads)}
    indices = {"buffer": 0, "byteOffset": 48 * len(quads), "byteLength": 12}
    corners = [
        {"bufferView": 0, "byteOffset": 48 * n, "componentType": 5126, "type": "VEC3", "count": 4}
        for n in range(len(quads))
    ]
    material = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1]}}
    document = {
        "asset": {"version": "2.0"},
        "materials": [material],
        "buffers": [
            {
                "byteLength": len(data),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()
                if buffer_uri is None
                else buffer_uri,
            }
        ],
        "bufferViews": [vertices, indices],
        "accessors": [{"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 6}, *corners],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 1 + n}, "indices": 0, "material": 0}]}
            for n in range(len(quads))
        ],
        "nodes": [{"name": name, "mesh": n} for n, name in enumerate(quads)],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(quads)))}],
    }
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path if buffer_uri is None else data


# In one sector, with a wall in its north; the wall's other side comes by turning the order round.
LAWN = [(1, 1, 0), (31, 1, 0), (31, 31, 0), (1, 31, 0)]
WALL = [(1, 30, 0), (31, 30, 0), (31, 30, 16), (1, 30, 16)]


def with_lamps(path, groups):
    """The map with a lamp over the lawn for each of so many light groups."""
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    lamp = {"type": "point", "intensity": 1000}
    extension = "KHR_lights_punctual"
    document.update(extensionsUsed=[extension], extensions={extension: {"lights": [lamp]}})
    for n in range(groups):
        document["scenes"][0]["nodes"].append(len(document["nodes"]))
        document["nodes"].append(
            {
                "translation": [3 + 3 * n, 3, -16],
                "extensions": {extension: {"light": 0}},
                "extras": {"light_group": f"group {n}"},
            }
        )
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return path


def change(path, edit):
    """Applies an edit of a glTF document that has its buffer inside; the edit gets the document, and may give bytes to append."""
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    buffer = document["buffers"][0]
    prefix, data = buffer["uri"].split(",")
    data = base64.b64decode(data) + (edit(document) or b"")
    buffer.update(byteLength=len(data), uri=prefix + "," + base64.b64encode(data).decode())
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)


def lawn_with_ballast(path, size):
    """A map whose buffer has so many bytes that nothing uses."""
    data = write_map(path, "data.bin", lawn=LAWN)
    with open(os.path.join(os.path.dirname(path), "data.bin"), "wb") as file:
        file.write(data + os.urandom(size))
    return path


def with_many_instances(path, count):
    """The map with its first mesh so many times more: an import that takes seconds."""

    def edit(document):
        start = document["buffers"][0]["byteLength"]
        document["bufferViews"].append({"buffer": 0, "byteOffset": start, "byteLength": 12 * count})
        document["accessors"].append(
            {
                "bufferView": len(document["bufferViews"]) - 1,
                "componentType": 5126,
                "type": "VEC3",
                "count": count,
            }
        )
        extension = "EXT_mesh_gpu_instancing"
        document["extensionsUsed"] = [extension]
        attributes = {"TRANSLATION": len(document["accessors"]) - 1}
        document["nodes"].append({"mesh": 0, "extensions": {extension: {"attributes": attributes}}})
        document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)
        return struct.pack("<3f", 1, 0, 1) * count

    change(path, edit)
