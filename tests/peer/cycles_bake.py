"""Runs inside Blender (`blender -b --factory-startup -P cycles_bake.py -- REQUEST.json ANSWER.json`): builds the map's
geometry with Lambert surfaces only, and lets Cycles bake E/pi onto one small white square a probe and direction.

A square is a white Lambert surface that no ray but its own can see, so what it radiates is E/pi. Each is one pixel of
the baked picture. All stand in one mesh, together with their replicas: same place, another random sequence.
"""
import json
import os
import sys
import tempfile
import time

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from gltf_scene import BLEND, GltfScene  # noqa: E402

# A square's side. Small beside a probe's distance from any surface; large beside the rounding of its corners, which
# lie within some 100 m of the origin (2^-18 m): its normal is true to 1e-3.
SQUARE_M = 0.01
MAX_ALBEDO = 0.95  # as drtv clamps it
LEAF_TRANSMISSION = 0.5
MAX_MASKED_LAYERS = 1024  # a ray may pass this many masked texels: all
EXTENSION = {10497: "REPEAT", 33071: "EXTEND", 33648: "MIRROR"}


class Nodes:
    """A node tree, by short words."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def new(self, kind, *inputs, **attributes):
        """A node; an input is a number, a tuple or a socket, None leaves its default."""
        node = self.tree.nodes.new(kind)
        for name, value in attributes.items():
            setattr(node, name, value)
        for socket, value in zip(node.inputs, inputs):
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            elif value is not None:
                socket.default_value = value
        return node

    def maths(self, operation, *inputs):
        return self.new("ShaderNodeMath", *inputs, operation=operation).outputs[0]

    def vector(self, operation, *inputs):
        node = self.new("ShaderNodeVectorMath", *inputs, operation=operation)
        return node.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]


def linear_image(data, ending):
    """The picture with its colours decoded: Cycles would filter the encoded ones, drtv filters linear ones."""
    with tempfile.NamedTemporaryFile(suffix=ending) as file:
        file.write(data)
        file.flush()
        encoded = bpy.data.images.load(file.name)
        encoded.colorspace_settings.name = "Non-Color"
        encoded.alpha_mode = "CHANNEL_PACKED"
        width, height = encoded.size
        pixels = np.empty(width * height * 4, np.float32)
        encoded.pixels.foreach_get(pixels)
        bpy.data.images.remove(encoded)
    rgba = pixels.reshape(-1, 4).astype(float)
    s = rgba[:, :3]
    rgba[:, :3] = np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)
    image = bpy.data.images.new("linear", width, height, alpha=True, float_buffer=True, is_data=True)
    image.alpha_mode = "CHANNEL_PACKED"
    image.pixels.foreach_set(rgba.astype(np.float32).ravel())
    return image


def make_material(source, has_colours, two_sided, leaf, images):
    material = bpy.data.materials.new("map")
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    colour, alpha = source.factor[:3], source.factor[3]
    if source.texture >= 0:
        texture = nodes.new(
            "ShaderNodeTexImage",
            image=images[source.texture],
            interpolation="Linear",
            extension=EXTENSION[source.wrap],
        )
        colour = nodes.vector("MULTIPLY", colour, texture.outputs["Color"])
        alpha = nodes.maths("MULTIPLY", alpha, texture.outputs["Alpha"])
    if has_colours:
        attribute = nodes.new("ShaderNodeAttribute", attribute_name="albedo")
        colour = nodes.vector("MULTIPLY", colour, attribute.outputs["Color"])
        alpha = nodes.maths("MULTIPLY", alpha, attribute.outputs["Alpha"])
    albedo = nodes.vector("MINIMUM", colour, (MAX_ALBEDO,) * 3)
    if not two_sided:  # the back is black, and blocks
        front = nodes.maths("SUBTRACT", 1.0, nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"])
        albedo = nodes.vector(
            "MULTIPLY", albedo, nodes.new("ShaderNodeCombineXYZ", front, front, front).outputs[0]
        )
    if leaf:  # lets half of what it sends back through; both together are no more than the limit
        albedo = nodes.vector("MINIMUM", albedo, (MAX_ALBEDO / (1 + LEAF_TRANSMISSION),) * 3)
    surface = nodes.new("ShaderNodeBsdfDiffuse", albedo, 0.0).outputs[0]
    if leaf:
        through = nodes.vector("MULTIPLY", albedo, (LEAF_TRANSMISSION,) * 3)
        surface = nodes.new(
            "ShaderNodeAddShader", surface, nodes.new("ShaderNodeBsdfTranslucent", through).outputs[0]
        ).outputs[0]
    if source.cutoff != -1:
        hole = (
            nodes.maths("SUBTRACT", 1.0, alpha)
            if source.cutoff == BLEND
            else nodes.maths("LESS_THAN", alpha, source.cutoff)
        )
        surface = nodes.new(
            "ShaderNodeMixShader",
            hole,
            surface,
            nodes.new("ShaderNodeBsdfTransparent", (1, 1, 1, 1)).outputs[0],
        ).outputs[0]
    nodes.new("ShaderNodeOutputMaterial", surface)
    return material


def make_mesh(name, positions, polygons, uvs=None, colours=None):
    """Flat shaded. uvs: one a corner; colours: one a vertex."""
    mesh = bpy.data.meshes.new(name)
    corners = polygons.shape[1]
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    mesh.loops.add(polygons.size)
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(polygons, np.int32).ravel())
    mesh.polygons.add(len(polygons))
    mesh.polygons.foreach_set("loop_start", np.arange(0, polygons.size, corners, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(polygons), corners, np.int32))
    if uvs is not None:
        mesh.uv_layers.new(name="uv").data.foreach_set("uv", np.ascontiguousarray(uvs, np.float32).ravel())
    if colours is not None:
        mesh.color_attributes.new("albedo", "FLOAT_COLOR", "POINT").data.foreach_set(
            "color", np.ascontiguousarray(colours, np.float32).ravel()
        )
    mesh.update(calc_edges=True)
    return mesh


class MapBuilder:
    def __init__(self, scene, collection, origin):
        self.scene, self.collection = scene, collection
        self.images = [linear_image(*picture) for picture in scene.pictures]
        self.materials, self.meshes = {}, {}
        # Through a parent's inverse Blender takes any affine matrix as it is; set directly it would lose shear.
        self.root = bpy.data.objects.new("root", None)
        collection.objects.link(self.root)
        for instance in scene.instances:
            matrix = instance.world_from_object.copy()
            matrix[:3, 3] -= origin
            for mesh in self.meshes_of(instance.mesh, instance.vegetation):
                placed = bpy.data.objects.new("map", mesh)
                placed.parent = self.root
                placed.matrix_parent_inverse = Matrix(matrix.tolist())
                collection.objects.link(placed)

    def meshes_of(self, index, vegetation):
        """One Blender mesh a primitive."""
        key = (index, vegetation)
        if key not in self.meshes:
            self.meshes[key] = []
            for primitive in self.scene.meshes[index]:
                two_sided = vegetation or primitive.material.two_sided
                worn = (
                    primitive.material,
                    primitive.colours is not None,
                    two_sided,
                    vegetation and primitive.material.thin,
                )
                if worn not in self.materials:
                    self.materials[worn] = make_material(*worn, self.images)
                uvs = (
                    None if primitive.uvs is None else (primitive.uvs * (1, -1) + (0, 1))[primitive.triangles]
                )
                mesh = make_mesh("map", primitive.positions, primitive.triangles, uvs, primitive.colours)
                mesh.materials.append(self.materials[worn])
                self.meshes[key].append(mesh)
        return self.meshes[key]


def make_squares(collection, probes, directions, replicas):
    """The object to bake onto; pixel (b, row) is direction b of probe row // replicas."""
    rows, columns = len(probes) * replicas, len(directions)
    positions, uvs = [], []
    for row in range(rows):
        for column, direction in enumerate(directions):
            normal = np.array(direction) / np.linalg.norm(direction)
            side = np.cross(normal, (1.0, 0, 0) if abs(normal[0]) < 0.5 else (0, 1.0, 0))
            side *= SQUARE_M / 2 / np.linalg.norm(side)
            up = np.cross(
                normal, side
            )  # (side, up, normal) is right-handed: counter-clockwise from the front
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                positions.append(probes[row // replicas] + s * side + t * up)
                uvs.append(((column + 0.5 + s / 2) / columns, (row + 0.5 + t / 2) / rows))
    mesh = make_mesh("squares", np.array(positions), np.arange(len(positions)).reshape(-1, 4), uvs)
    squares = bpy.data.objects.new("squares", mesh)
    for kind in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        setattr(squares, "visible_" + kind, False)
    material = bpy.data.materials.new("white")
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    nodes.new("ShaderNodeOutputMaterial", nodes.new("ShaderNodeBsdfDiffuse", (1, 1, 1, 1), 0.0).outputs[0])
    image = bpy.data.images.new("baked", columns, rows, alpha=False, float_buffer=True, is_data=True)
    material.node_tree.nodes.active = nodes.new("ShaderNodeTexImage", image=image)
    mesh.materials.append(material)
    collection.objects.link(squares)
    bpy.context.view_layer.objects.active = squares
    squares.select_set(True)
    return image


def set_sky(world, axis):
    """Radiance 1 + axis . w above the horizon, black below."""
    world.use_nodes = True
    nodes = Nodes(world.node_tree)
    w = nodes.new("ShaderNodeTexCoord").outputs["Generated"]
    up = nodes.maths("GREATER_THAN", nodes.vector("DOT_PRODUCT", w, (0, 0, 1)), 0.0)
    radiance = nodes.maths(
        "MULTIPLY", up, nodes.maths("ADD", 1.0, nodes.vector("DOT_PRODUCT", w, tuple(axis)))
    )
    nodes.new("ShaderNodeOutputWorld", nodes.new("ShaderNodeBackground", (1, 1, 1, 1), radiance).outputs[0])


def set_up_cycles(scene, request):
    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", request["threads"]
    scene.view_settings.view_transform = "Raw"
    scene.render.bake.margin = 0
    c = scene.cycles
    c.device = "CPU"
    # The square is the path's first vertex; what comes after it are the surfaces of the map.
    c.max_bounces = c.diffuse_bounces = c.transmission_bounces = request["bounces"]
    c.transparent_max_bounces = MAX_MASKED_LAYERS
    c.use_adaptive_sampling = c.use_denoising = c.use_fast_gi = False
    c.sample_clamp_direct = c.sample_clamp_indirect = c.blur_glossy = c.light_sampling_threshold = 0
    c.sampling_pattern = "SOBOL"  # Owen-scrambled anew for each pixel: replicas are independent
    scene.world.cycles.sampling_method = request["sky_sampling"]


def farthest(scene, probes):
    """Distance of the farthest point of the map's boxes from any probe."""
    corners = []
    for instance in scene.instances:
        for primitive in scene.meshes[instance.mesh]:
            low, high = primitive.positions.min(0), primitive.positions.max(0)
            box = np.array([[(low, high)[k >> a & 1][a] for a in range(3)] for k in range(8)])
            corners.append(box @ instance.world_from_object[:3, :3].T + instance.world_from_object[:3, 3])
    corners = np.concatenate(corners)
    return max(np.linalg.norm(corners - probe, axis=1).max() for probe in probes)


def main():
    request_path, answer_path = sys.argv[sys.argv.index("--") + 1 :]
    with open(request_path, encoding="utf-8") as file:
        request = json.load(file)
    probes = np.array(request["probes"])
    origin = probes.mean(0)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_scene = bpy.context.scene
    blender_scene.world = bpy.data.worlds.new("sky")
    gltf = GltfScene(request["map"])
    MapBuilder(gltf, blender_scene.collection, origin)
    set_up_cycles(blender_scene, request)
    image = make_squares(
        blender_scene.collection, probes - origin, request["directions"], request["replicas"]
    )
    answer = {"farthest_m": farthest(gltf, probes), "blender": bpy.app.version_string, "passes": []}
    for task in request["passes"]:
        set_sky(blender_scene.world, task["axis"])
        blender_scene.cycles.samples = task["samples"]
        begun = time.process_time()
        bpy.ops.object.bake(type="DIFFUSE", pass_filter=set(task["light"]), margin=0, use_clear=True)
        cpu_seconds = time.process_time() - begun
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        values = pixels.reshape(len(probes), request["replicas"], len(request["directions"]), 4)[..., :3]
        # by probe, direction, replica, channel
        answer["passes"].append(
            {
                "name": task["name"],
                "cpu_seconds": cpu_seconds,
                "values": values.transpose(0, 2, 1, 3).astype(float).tolist(),
            }
        )
    with open(answer_path, "w", encoding="utf-8") as file:
        json.dump(answer, file)


main()
