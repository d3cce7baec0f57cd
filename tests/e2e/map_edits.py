"""Random edits of a glTF map as artists make them. Each is a function of the document, its buffer, and a random generator; it changes both in place and
says what it did. The same seed makes the same edit."""
import json
import os
import random
import shutil
import struct


# The empty one is none.
LIGHT_GROUPS = ("", "lanterns", "huts")


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


def regroup_light(map_, rng):
    number = rng.choice(map_.lights())
    extras = map_.nodes[number].setdefault("extras", {})
    extras["light_group"] = rng.choice([name for name in LIGHT_GROUPS if name != extras.get("light_group")])
    return f"{map_.nodes[number].get('name', number)} joins '{extras['light_group']}'"


def add_probe(map_, rng):
    place = map_.nodes[rng.choice(map_.plants())]["translation"]
    map_.document["scenes"][map_.document.get("scene", 0)]["nodes"].append(len(map_.nodes))
    at = [place[0] + rng.uniform(-3, 3), place[1] + rng.uniform(0.5, 3), place[2] + rng.uniform(-3, 3)]
    map_.nodes.append(
        {"name": f"probe_{len(map_.nodes)}", "translation": at, "extras": {"bake_role": "probe"}}
    )
    return f"a probe at {at}"


# Triangles of a unit box, its middle at the ground, and of an upright sheet.
BOX = (
    [(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)],
    [
        0,
        2,
        1,
        1,
        2,
        3,
        4,
        5,
        6,
        5,
        7,
        6,
        0,
        1,
        4,
        1,
        5,
        4,
        2,
        6,
        3,
        3,
        6,
        7,
        0,
        4,
        2,
        2,
        4,
        6,
        1,
        3,
        5,
        3,
        7,
        5,
    ],
)
SHEET = ([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], [0, 1, 2, 0, 2, 3])


def _two_sided_mesh(map_, name, shape):
    """The number of the mesh of that name, made when it is not there yet."""
    document = map_.document
    for number, mesh in enumerate(document["meshes"]):
        if mesh.get("name") == name:
            return number

    def add(items, item):
        document.setdefault(items, []).append(item)
        return len(document[items]) - 1

    def add_values(code, values, component, kind, **more):
        map_.buffer += bytes(-len(map_.buffer) % 4)
        data = struct.pack(f"<{len(values)}{code}", *values)
        view = add("bufferViews", {"buffer": 0, "byteOffset": len(map_.buffer), "byteLength": len(data)})
        map_.buffer += data
        return add("accessors", {"bufferView": view, "componentType": component, "type": kind, **more})

    points, indices = shape
    bounds = {
        "min": [min(p[k] for p in points) for k in range(3)],
        "max": [max(p[k] for p in points) for k in range(3)],
    }
    position = add_values("f", [x for p in points for x in p], 5126, "VEC3", count=len(points), **bounds)
    index = add_values("H", indices, 5123, "SCALAR", count=len(indices))
    material = add(
        "materials", {"doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0.4, 0.3, 0.2, 1]}}
    )
    primitive = {"attributes": {"POSITION": position}, "indices": index, "material": material}
    return add("meshes", {"name": name, "primitives": [primitive]})


def _place(map_, rng, name, shape, size, extras):
    """A new thing beside a plant, or one of that name that is there already, moved."""
    there = [number for number, node in enumerate(map_.nodes) if node.get("name", "").startswith(name)]
    if there and rng.random() < 0.6:
        return _move(map_, rng.choice(there), rng, 8)
    place = map_.nodes[rng.choice(map_.plants())]["translation"]
    node = {"name": f"{name}{len(map_.nodes)}", "translation": list(place), "scale": size}
    if shape:
        node["mesh"] = _two_sided_mesh(map_, "two-sided box" if shape is BOX else "two-sided sheet", shape)
    if extras:
        node["extras"] = extras
    _shift(node, rng, 20)
    map_.document["scenes"][map_.document.get("scene", 0)]["nodes"].append(len(map_.nodes))
    map_.nodes.append(node)
    return f"{node['name']} at {node['translation']}"


def place_solid(map_, rng):
    """A block with two sides, static or vegetation."""
    size = [rng.uniform(2, 14), rng.uniform(3, 10), rng.uniform(2, 14)]
    return _place(map_, rng, "solid_", BOX, size, rng.choice([None, {"bake_role": "vegetation"}]))


def place_wall(map_, rng):
    return _place(map_, rng, "wall_", SHEET, [rng.uniform(6, 20), rng.uniform(4, 12), 1], None)


def place_volume(map_, rng):
    """Of any kind; an interior takes a probe that stands in it."""
    extras = rng.choice(
        [{"bake_role": "no_probes"}, {"bake_spacing": rng.choice([2, 3])}, {"bake_role": "interior"}]
    )
    size = [rng.uniform(8, 24), rng.uniform(6, 20), rng.uniform(8, 24)]
    return _place(map_, rng, "volume_", BOX, size, extras)


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
    regroup_light,
    add_probe,
    place_solid,
    place_wall,
    place_volume,
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
