"""Reads what a bake needs of a glTF file, with none of drtv's code: triangles, base colours, sides, masks, roles.

Only what the maps in use have; anything else raises, so that no comparison runs on half a map. World axes are
drtv's and Blender's: glTF (x, y, z) is (x, -z, y).
"""
import base64
import dataclasses
import json
import os
import struct
import urllib.parse

import numpy as np

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WORLD_FROM_GLTF = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], float)
NOT_GEOMETRY = {"ignore", "probe", "no_probes", "interior"}
UNDERSTOOD = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_texture_transform",
    "EXT_mesh_gpu_instancing",
}
REPEAT = 10497
BLEND = -2


@dataclasses.dataclass(frozen=True)
class Material:
    factor: tuple  # linear RGBA
    texture: int  # index of the picture, -1: none
    wrap: int  # glTF's number
    two_sided: bool
    cutoff: float  # alpha below it lets light through; -1: opaque, BLEND: alpha is the share that is there
    thin: bool  # double-sided or with alpha: a leaf, when it is vegetation


@dataclasses.dataclass
class Primitive:
    material: Material
    positions: np.ndarray  # n x 3
    triangles: np.ndarray  # m x 3
    uvs: np.ndarray  # n x 2, after KHR_texture_transform, v downwards; or None
    colours: np.ndarray  # n x 4 linear; or None


@dataclasses.dataclass
class Instance:
    mesh: int
    world_from_object: np.ndarray
    vegetation: bool  # both sides reflect, whatever the material says


class GltfScene:
    """meshes: a list of primitives each; instances; pictures: encoded bytes and a file ending."""

    def __init__(self, path):
        self.folder = os.path.dirname(path)
        with open(path, "rb") as file:
            data = file.read()
        self.chunk = None
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            self.json = json.loads(data[20 : 20 + length])
            self.chunk = data[20 + length + 8 :]
        else:
            self.json = json.loads(data)
        unknown = set(self.json.get("extensionsUsed", [])) - UNDERSTOOD
        if unknown:
            raise ValueError(f"{path}: this reader does not know {sorted(unknown)}")
        self.buffers = [self._bytes_of(b) for b in self.json.get("buffers", [])]
        self.pictures = [self._picture(i) for i in self.json.get("images", [])]
        self.meshes = [
            [p for source in m["primitives"] for p in self._primitives(source) if len(p.triangles)]
            for m in self.json.get("meshes", [])
        ]
        self.instances = []
        scene = self.json["scenes"][self.json.get("scene", 0)]
        for root in scene["nodes"]:
            self._add_node(root, WORLD_FROM_GLTF, "static")

    def _bytes_of(self, entry):
        uri = entry.get("uri")
        if uri is None:
            return self.chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(self.folder, urllib.parse.unquote(uri)), "rb") as file:
            return file.read()

    def _picture(self, image):
        if "bufferView" in image:
            view = self.json["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            data = self.buffers[view["buffer"]][start : start + view["byteLength"]]
        else:
            data = self._bytes_of(image)
        return data, ".png" if data[:4] == b"\x89PNG" else ".jpg"

    def _accessor(self, index):
        accessor = self.json["accessors"][index]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise ValueError(f"accessor {index}: sparse, or without bufferView")
        view = self.json["bufferViews"][accessor["bufferView"]]
        dtype, width, count = (
            np.dtype(TYPES[accessor["componentType"]]),
            COMPONENTS[accessor["type"]],
            accessor["count"],
        )
        stride = view.get("byteStride", dtype.itemsize * width)
        values = np.ndarray(
            (count, width),
            dtype,
            self.buffers[view["buffer"]],
            view.get("byteOffset", 0) + accessor.get("byteOffset", 0),
            (stride, dtype.itemsize),
        )
        if accessor.get("normalized"):
            return np.maximum(values.astype(np.float32) / np.iinfo(dtype).max, -1)
        return values.copy()

    def _material(self, index):
        source = self.json["materials"][index] if index is not None else {}
        pbr = source.get("pbrMetallicRoughness", {})
        texture, wrap = -1, REPEAT
        if "baseColorTexture" in pbr:
            entry = self.json["textures"][pbr["baseColorTexture"]["index"]]
            sampler = self.json["samplers"][entry["sampler"]] if "sampler" in entry else {}
            texture, wrap = entry["source"], sampler.get("wrapS", REPEAT)
            if sampler.get("wrapT", REPEAT) != wrap:
                raise ValueError(f"material {index}: wraps differently in u and v")
        mode = source.get("alphaMode", "OPAQUE")
        cutoff = {"OPAQUE": -1, "MASK": source.get("alphaCutoff", 0.5), "BLEND": BLEND}[mode]
        return Material(
            tuple(pbr.get("baseColorFactor", (1, 1, 1, 1))),
            texture,
            wrap,
            source.get("doubleSided", False),
            cutoff,
            source.get("doubleSided", False) or mode != "OPAQUE",
        )

    def _uvs(self, source, material_index):
        info = self.json["materials"][material_index]["pbrMetallicRoughness"]["baseColorTexture"]
        change = info.get("extensions", {}).get("KHR_texture_transform", {})
        uvs = self._accessor(
            source["attributes"][f"TEXCOORD_{change.get('texCoord', info.get('texCoord', 0))}"]
        ).astype(float)
        c, s = np.cos(change.get("rotation", 0)), np.sin(change.get("rotation", 0))
        return (uvs * change.get("scale", (1, 1))) @ np.array([[c, s], [-s, c]]).T + change.get(
            "offset", (0, 0)
        )

    def _primitives(self, source):
        """Two: the triangles, and those of them that are one of a pair, see twins()."""
        if source.get("mode", 4) != 4:
            raise ValueError(f"primitive of mode {source['mode']}: only triangles are read")
        material, attributes = self._material(source.get("material")), source["attributes"]
        positions = self._accessor(attributes["POSITION"]).astype(np.float32)
        indices = (
            self._accessor(source["indices"]).ravel() if "indices" in source else np.arange(len(positions))
        )
        t = indices[: len(indices) // 3 * 3].reshape(-1, 3).astype(np.int32)
        t = t[(t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])]
        uvs = self._uvs(source, source["material"]) if material.texture >= 0 else None
        colours = None
        if "COLOR_0" in attributes:
            colours = np.ones((len(positions), 4), np.float32)
            values = self._accessor(attributes["COLOR_0"])
            colours[:, : values.shape[1]] = values
        single, paired = twins(positions, t)
        return [
            Primitive(material, positions, t[single], uvs, colours),
            Primitive(dataclasses.replace(material, two_sided=True), positions, t[paired], uvs, colours),
        ]

    def _add_node(self, number, world_from_parent, role):
        node = self.json["nodes"][number]
        role = node.get("extras", {}).get("bake_role", role)
        world_from_node = world_from_parent @ local_transform(node)
        if "mesh" in node and role not in NOT_GEOMETRY and self.meshes[node["mesh"]]:
            for instance in self._instances_of(node):
                self.instances.append(
                    Instance(node["mesh"], world_from_node @ instance, role == "vegetation")
                )
        for child in node.get("children", []):
            self._add_node(child, world_from_node, role)

    def _instances_of(self, node):
        instancing = node.get("extensions", {}).get("EXT_mesh_gpu_instancing")
        if instancing is None:
            return [np.eye(4)]
        columns = {
            name.lower(): self._accessor(index).astype(float)
            for name, index in instancing["attributes"].items()
            if name in ("TRANSLATION", "ROTATION", "SCALE")
        }
        count = len(next(iter(columns.values())))
        return [local_transform({name: column[n] for name, column in columns.items()}) for n in range(count)]


def twins(positions, triangles):
    """Indices of triangles that stand alone, and of one out of each pair that has the same three corners.

    Leaves are often modelled so, once a side: together they are one surface with two sides. A path in Cycles that
    leaves one of the two may hit the other at once, so that both are black: of a plane of albedo 0.5 laid twice nothing
    came back at all, where paper (and drtv) say 0.5. So a pair is given to Cycles as what it means.
    """
    corners = np.sort(np.unique(positions, axis=0, return_inverse=True)[1][triangles], axis=1)
    _, first, count = np.unique(corners, axis=0, return_index=True, return_counts=True)
    return np.sort(first[count == 1]), np.sort(first[count > 1])


def local_transform(node):
    """4 x 4, of a node's matrix or its translation, rotation and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", (0, 0, 0, 1)), float) / np.linalg.norm(
        node.get("rotation", (0, 0, 0, 1))
    )
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    local = np.eye(4)
    local[:3, :3] = rotation * np.array(node.get("scale", (1, 1, 1)), float)
    local[:3, 3] = node.get("translation", (0, 0, 0))
    return local
