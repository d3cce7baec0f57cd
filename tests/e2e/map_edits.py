"""Random edits of a glTF map as artists make them. Each is a function of the document, its buffer, and a random generator; it changes both in place and
says what it did. The same seed makes the same edit."""
import json
import os
import random
import shutil
import struct


class EditableMap:
    """A .gltf with one external buffer, and files beside it."""

    def __init__(self, path):
        self.folder, self.name = os.path.dirname(path), os.path.basename(path)
        with open(path, encoding="utf-8") as file:
            self.document = json.load(file)
        self.buffer_name = self.document["buffers"][0]["uri"]
        with open(os.path.join(self.folder, self.buffer_name), "rb") as file:
            self.buffer = bytearray(file.read())

    def write(self, folder):
        os.makedirs(folder, exist_ok=True)
        for name in os.listdir(self.folder):
            if name not in (self.name, self.buffer_name) and not os.path.exists(os.path.join(folder, name)):
                shutil.copy(os.path.join(self.folder, name), folder)
        self.document["buffers"][0]["byteLength"] = len(self.buffer)
        with open(os.path.join(folder, self.buffer_name), "wb") as file:
            file.write(self.buffer)
        path = os.path.join(folder, self.name)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.document, file)
        return path

    @property
    def nodes(self):
        return self.document["nodes"]

    def parent_of(self, number):
        return next((node for node in self.nodes if number in node.get("children", [])), None)

    def plants(self):
        """Numbers of placed meshes in vegetation groups."""
        groups = [node for node in self.nodes if node.get("extras", {}).get("bake_role") == "vegetation"]
        return [
            child for group in groups for child in group.get("children", []) if "mesh" in self.nodes[child]
        ]

    def placed(self):
        return [
            number
            for number, node in enumerate(self.nodes)
            if "mesh" in node and "translation" in node and not node.get("extras")
        ]

    def lights(self):
        return [
            number
            for number, node in enumerate(self.nodes)
            if "KHR_lights_punctual" in node.get("extensions", {})
        ]


def _shift(node, rng, metres):
    at = node.setdefault("translation", [0.0, 0.0, 0.0])
    for axis in (0, 2):
        at[axis] += rng.uniform(-metres, metres)


def _move(map_, number, rng, metres):
    _shift(map_.nodes[number], rng, metres)
    return f"node {number} ({map_.nodes[number].get('name')})"


def move_plant(map_, rng):
    return _move(map_, rng.choice(map_.plants()), rng, 6)


def move_far(map_, rng):
    return _move(map_, rng.choice(map_.plants()), rng, 200)


def move_building(map_, rng):
    plants = set(map_.plants())
    number = rng.choice([number for number in map_.placed() if number not in plants])
    return _move(map_, number, rng, 3)


def delete_plant(map_, rng):
    number = rng.choice(map_.plants())
    map_.parent_of(number)["children"].remove(number)
    return f"node {number} ({map_.nodes[number].get('name')})"


def add_plant(map_, rng):
    number = rng.choice(map_.plants())
    copy = json.loads(json.dumps(map_.nodes[number]))
    copy["name"] = f"added_{len(map_.nodes)}"
    _shift(copy, rng, 40)
    map_.parent_of(number)["children"].append(len(map_.nodes))
    map_.nodes.append(copy)
    return f"a copy of node {number} at {copy['translation']}"


def recolour_material(map_, rng):
    materials = [
        number
        for number, material in enumerate(map_.document["materials"])
        if "pbrMetallicRoughness" in material
    ]
    number = rng.choice(materials)
    colour = map_.document["materials"][number]["pbrMetallicRoughness"].setdefault(
        "baseColorFactor", [1, 1, 1, 1]
    )
    colour[rng.randrange(3)] *= rng.uniform(0.5, 1)
    return f"material {number}"


def change_role(map_, rng):
    """A plant that is static from now on, or the other way round."""
    number = rng.choice(map_.plants())
    node = map_.nodes[number]
    role = "static" if node.get("extras", {}).get("bake_role") != "static" else "vegetation"
    node["extras"] = {"bake_role": role}
    return f"node {number} ({node.get('name')}) is {role}"


def edit_shared_mesh(map_, rng):
    used = {}
    for number in map_.plants():
        used.setdefault(map_.nodes[number]["mesh"], []).append(number)
    mesh = rng.choice(sorted(used))
    primitive = rng.choice(map_.document["meshes"][mesh]["primitives"])
    accessor = map_.document["accessors"][primitive["attributes"]["POSITION"]]
    view = map_.document["bufferViews"][accessor["bufferView"]]
    stride, start = view.get("byteStride", 12), view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    wider = rng.uniform(1.05, 1.3)
    positions = []
    for n in range(accessor["count"]):
        x, y, z = struct.unpack_from("<3f", map_.buffer, start + n * stride)
        struct.pack_into("<3f", map_.buffer, start + n * stride, x * wider, y, z * wider)
        positions.append(struct.unpack_from("<3f", map_.buffer, start + n * stride))
    accessor["min"], accessor["max"] = [min(p[k] for p in positions) for k in range(3)], [
        max(p[k] for p in positions) for k in range(3)
    ]
    return f"mesh {mesh}, {len(used[mesh])} plants"


def move_light(map_, rng):
    return _move(map_, rng.choice(map_.lights()), rng, 0.3)


def dim_light(map_, rng):
    lights = map_.document["extensions"]["KHR_lights_punctual"]["lights"]
    number = rng.randrange(len(lights))
    lights[number]["intensity"] *= rng.uniform(0.5, 1.5)
    return f"light {number}"


def add_probe(map_, rng):
    place = map_.nodes[rng.choice(map_.plants())]["translation"]
    map_.document["scenes"][map_.document.get("scene", 0)]["nodes"].append(len(map_.nodes))
    at = [place[0] + rng.uniform(-3, 3), place[1] + rng.uniform(0.5, 3), place[2] + rng.uniform(-3, 3)]
    map_.nodes.append(
        {"name": f"probe_{len(map_.nodes)}", "translation": at, "extras": {"bake_role": "probe"}}
    )
    return f"a probe at {at}"


def rename_node(map_, rng):
    number = rng.choice(map_.plants())
    map_.nodes[number]["name"] = f"renamed_{rng.randrange(10**6)}"
    return f"node {number}"


def reorder_buffer(map_, rng):
    """As another exporter would write it: the parts of the buffer in another order."""
    views = map_.document["bufferViews"]
    order = list(range(len(views)))
    rng.shuffle(order)
    buffer = bytearray()
    for number in order:
        view = views[number]
        start = view.get("byteOffset", 0)
        while len(buffer) % 4:
            buffer.append(0)
        view["byteOffset"] = len(buffer)
        buffer += map_.buffer[start : start + view["byteLength"]]
    map_.buffer = buffer
    return "all views"


def touch(_map, _rng):
    return "written again as it was"


EDITS = (
    move_plant,
    move_far,
    move_building,
    delete_plant,
    add_plant,
    recolour_material,
    change_role,
    edit_shared_mesh,
    move_light,
    dim_light,
    add_probe,
    rename_node,
    reorder_buffer,
    touch,
)
NOTHING_TO_BAKE = (rename_node, reorder_buffer, touch)


def edit(map_, seed):
    """One random edit; gives the function and what it did."""
    rng = random.Random(seed)
    kind = rng.choice(EDITS)
    return kind, f"{kind.__name__}: {kind(map_, rng)}"
