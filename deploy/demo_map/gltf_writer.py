"""Writes glTF 2.0: one .gltf, one .bin, images beside them. Everything listed is used by something."""
import array
import json
import sys

FLOAT, UINT8, UINT16, UINT32 = 5126, 5121, 5123, 5125
VERTICES, INDICES = 34962, 34963


def little_endian(typecode, values):
    packed = array.array(typecode, values)
    if sys.byteorder == "big":
        packed.byteswap()
    return packed.tobytes()


def tidy(values, digits):
    """Rounded, and without minus zero."""
    return [round(value, digits) + 0.0 for value in values]


class GltfWriter:
    """`materials` maps a name to its glTF material; one becomes part of the file when a mesh first uses it."""

    def __init__(self, materials, image_uri, copyright_note):
        self.known_materials, self.image_uri = materials, image_uri
        self.material_index, self.binary = {}, bytearray()
        self.root = {
            "asset": {"version": "2.0", "generator": "make_demo_map.py", "copyright": copyright_note},
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": []}},
            "scene": 0,
            "scenes": [{"name": "island", "nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        }

    def light(self, name, colour, intensity_cd):
        lights = self.root["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"name": name, "type": "point", "color": list(colour), "intensity": intensity_cd})
        return len(lights) - 1

    def material(self, name):
        if name not in self.material_index:
            self.material_index[name] = len(self.root["materials"])
            self.root["materials"].append({"name": name, **self.known_materials[name]})
            for extension in self.known_materials[name].get("extensions", {}):
                if extension not in self.root["extensionsUsed"]:
                    self.root["extensionsUsed"].append(extension)
            if "baseColorTexture" in self.known_materials[name]["pbrMetallicRoughness"]:
                self.root.update(textures=[{"source": 0}], images=[{"uri": self.image_uri}])
        return self.material_index[name]

    def accessor(self, data, component, kind, count, target, **more):
        self.binary.extend(bytes(-len(self.binary) % 4))
        self.root["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), "target": target}
        )
        self.binary.extend(data)
        self.root["accessors"].append(
            {
                "bufferView": len(self.root["bufferViews"]) - 1,
                "componentType": component,
                "type": kind,
                "count": count,
                **more,
            }
        )
        return len(self.root["accessors"]) - 1

    def primitive(self, part):
        count = len(part.positions)
        floats = array.array("f", [value for position in part.positions for value in position])
        bounds = {
            "min": [min(floats[axis::3]) for axis in range(3)],
            "max": [max(floats[axis::3]) for axis in range(3)],
        }
        attributes = {
            "POSITION": self.accessor(little_endian("f", floats), FLOAT, "VEC3", count, VERTICES, **bounds)
        }
        if part.uvs:
            data = little_endian("f", [value for uv in part.uvs for value in uv])
            attributes["TEXCOORD_0"] = self.accessor(data, FLOAT, "VEC2", count, VERTICES)
        if part.colours:  # 16 bits: 8 would show steps in linear albedos as dark as ours
            data = little_endian(
                "H", [int(value * 65535 + 0.5) for rgb in part.colours for value in (*rgb, 1.0)]
            )
            attributes["COLOR_0"] = self.accessor(data, UINT16, "VEC4", count, VERTICES, normalized=True)
        corners = [index for triangle in part.triangles for index in triangle]
        code, component = ("H", UINT16) if count < 65535 else ("I", UINT32)
        indices = self.accessor(little_endian(code, corners), component, "SCALAR", len(corners), INDICES)
        result = {"attributes": attributes, "indices": indices}
        if part.material:
            result["material"] = self.material(part.material)
        return result

    def mesh(self, name, parts):
        self.root["meshes"].append({"name": name, "primitives": [self.primitive(part) for part in parts]})
        return len(self.root["meshes"]) - 1

    def node(
        self, parent, name, mesh=None, translation=None, rotation=None, scale=None, light=None, **extras
    ):
        node = {"name": name}
        if mesh is not None:
            node["mesh"] = mesh
        if translation is not None:
            node["translation"] = tidy(translation, 4)
        if rotation is not None:
            node["rotation"] = tidy(rotation, 7)
        if scale is not None:
            node["scale"] = tidy(scale, 5)
        if light is not None:
            node["extensions"] = {"KHR_lights_punctual": {"light": light}}
        if extras:
            node["extras"] = extras
        index = len(self.root["nodes"])
        self.root["nodes"].append(node)
        above = (
            self.root["scenes"][0]["nodes"]
            if parent is None
            else self.root["nodes"][parent].setdefault("children", [])
        )
        above.append(index)
        return index

    def write(self, folder, stem):
        self.root["buffers"] = [{"uri": stem + ".bin", "byteLength": len(self.binary)}]
        (folder / (stem + ".bin")).write_bytes(self.binary)
        text = json.dumps(self.root, separators=(",", ":"), allow_nan=False) + "\n"
        (folder / (stem + ".gltf")).write_bytes(text.encode("ascii"))
