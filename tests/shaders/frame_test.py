"""Rendered frames: an interior's mask, drawn, blurred and held against the geometry; and a scene's ambient light from
volumes and tiles, at full and at half resolution, held against the C++. Usage: SCRIPT SHADER_FOLDER WRITE_FRAME"""
import array
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

import moderngl

SHADERS, WRITE_FRAME = (os.path.abspath(path) for path in sys.argv[1:3])
WIDTH, HEIGHT = 320, 240
FIELD_OF_VIEW = math.radians(60)
OFFSET_M, SOFT_M = 0.5, 1.0
ROOM = ((-2.0, -2.0, -1.0), (2.0, 2.0, 2.5))

VERTEX = """#version 450
uniform mat4 to_screen;
in vec3 place;
out vec3 v_place;
void main() { gl_Position = to_screen * vec4(place, 1.0); v_place = place; }
"""
SURFACE = """#version 450
uniform vec3 camera;
in vec3 v_place;
out vec4 shown;
void main() { shown = vec4(v_place, distance(camera, v_place)); }
"""
MASK = """#version 450
uniform vec3 camera;
uniform float offset;
layout(binding = 0) uniform sampler2D surfaces;
in vec3 v_place;
out float winding;
#define DRTV_FETCH_MASK(pixel) vec2(0.0)
#define DRTV_FETCH_AMBIENT(pixel) vec4(0.0)
#define DRTV_FETCH_SURFACE(pixel) vec4(0.0)
// HERE
void main() {
    float surface = texelFetch(surfaces, ivec2(gl_FragCoord.xy), 0).w - offset;
    winding = drtv_mask_winding(gl_FrontFacing, distance(camera, v_place), surface);
}
"""
BLUR = """#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D mask;
layout(rg32f, binding = 1) writeonly uniform image2D blurred;
uniform ivec2 axis;
uniform float pixels_per_metre, soft;
#define DRTV_FETCH_MASK(pixel) texelFetch(mask, clamp(pixel, ivec2(0), textureSize(mask, 0) - 1), 0).xy
#define DRTV_FETCH_AMBIENT(pixel) vec4(0.0)
#define DRTV_FETCH_SURFACE(pixel) vec4(0.0)
// HERE
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    imageStore(blurred, pixel, vec4(drtv_mask_blur(pixel, axis, pixels_per_metre, soft), 0.0, 0.0));
}
"""


def quad(a, b, c, d):
    return [a, b, c, a, c, d]


def box(low, high):
    """Fronts outwards, counter-clockwise."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return (
        quad((x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0))
        + quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
        + quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))
        + quad((x1, y1, z0), (x0, y1, z0), (x0, y1, z1), (x1, y1, z1))
        + quad((x0, y1, z0), (x0, y0, z0), (x0, y0, z1), (x0, y1, z1))
        + quad((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1))
    )


def normalised(v):
    length = math.hypot(*v)
    return [x / length for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def to_screen(camera, target):
    """Column after column."""
    forward = normalised([t - c for t, c in zip(target, camera)])
    right = normalised(cross(forward, (0, 0, 1)))
    up = cross(right, forward)
    near, far, scale = 0.05, 200.0, 1 / math.tan(FIELD_OF_VIEW / 2)
    rows = [
        [scale * HEIGHT / WIDTH * v for v in (*right, -dot(right, camera))],
        [scale * v for v in (*up, -dot(up, camera))],
    ]
    depth = [-v for v in (*forward, -dot(forward, camera))]  # of the view space, negative ahead
    a, b = -(far + near) / (far - near), -2 * far * near / (far - near)
    rows.append([a * v for v in depth])
    rows[2][3] += b
    rows.append([-v for v in depth])
    return [rows[row][column] for column in range(4) for row in range(4)]


def signed_distance(place):
    """To the room's mesh, above 0 inside."""
    outside = [max(low - p, p - high) for p, low, high in zip(place, *ROOM)]
    return -math.hypot(*(max(v, 0) for v in outside)) if max(outside) > 0 else -max(outside)


class Frame:
    def __init__(self, context, camera, target):
        self.context, self.camera = context, camera
        self.matrix = array.array("f", to_screen(camera, target)).tobytes()
        with open(os.path.join(SHADERS, "drtv_passes.glsl"), encoding="utf-8") as file:
            self.include = file.read()
        self.surfaces = context.texture((WIDTH, HEIGHT), 4, dtype="f4")
        floor = quad((-30, -30, 0), (30, -30, 0), (30, 30, 0), (-30, 30, 0))
        pillar = box((-0.3, -0.3, 0), (0.3, 0.3, 1.5))
        depth = context.depth_texture((WIDTH, HEIGHT))
        target = context.framebuffer([self.surfaces], depth)
        target.use()
        target.clear()
        context.enable_only(moderngl.DEPTH_TEST)
        self.draw(SURFACE, floor + pillar)
        self.shown = array.array("f", self.surfaces.read())

    def draw(self, fragment, triangles, **uniforms):
        program = self.context.program(vertex_shader=VERTEX, fragment_shader=fragment)
        program["to_screen"].write(self.matrix)
        program["camera"].value = tuple(self.camera)
        for name, value in uniforms.items():
            program[name].value = value
        vertices = self.context.buffer(array.array("f", [v for p in triangles for v in p]).tobytes())
        self.context.vertex_array(program, [(vertices, "3f", "place")]).render()

    def windings(self):
        mask = self.context.texture((WIDTH, HEIGHT), 1, dtype="f4")
        target = self.context.framebuffer([mask])
        target.use()
        target.clear()
        self.surfaces.use(0)
        self.context.enable_only(moderngl.BLEND)
        self.context.blend_func = moderngl.ONE, moderngl.ONE
        self.draw(MASK.replace("// HERE", self.include), box(*ROOM), offset=OFFSET_M)
        return array.array("f", mask.read())

    def shares(self, windings):
        pairs = array.array("f", [v for n, w in enumerate(windings) for v in (w, self.shown[4 * n + 3])])
        source = self.context.texture((WIDTH, HEIGHT), 2, pairs.tobytes(), dtype="f4")
        shader = self.context.compute_shader(BLUR.replace("// HERE", self.include))
        shader["pixels_per_metre"].value = HEIGHT / 2 / math.tan(FIELD_OF_VIEW / 2)
        shader["soft"].value = SOFT_M
        for axis in ((1, 0), (0, 1)):
            blurred = self.context.texture((WIDTH, HEIGHT), 2, dtype="f4")
            shader["axis"].value = axis
            source.use(0)
            blurred.bind_to_image(1, read=False, write=True)
            shader.run(WIDTH // 8, HEIGHT // 8)
            source = blurred
        return array.array("f", source.read())[::2]

    def asked(self, n):
        """The surface of a pixel, moved towards the camera; nothing where it shows the sky."""
        place, metres = self.shown[4 * n : 4 * n + 3], self.shown[4 * n + 3]
        if metres == 0:
            return None
        return [p + (c - p) * OFFSET_M / metres for p, c in zip(place, self.camera)]


class Mask(unittest.TestCase):
    VIEWS = {"from outside": ((1, -9, 5), (0, 0, 0.5)), "from within": ((-1.2, -1.5, 1.6), (3, 6, 0))}

    def test_the_drawn_mask_is_the_winding_number(self):
        context = moderngl.create_standalone_context(backend="egl")
        for name, (camera, target) in self.VIEWS.items():
            frame = Frame(context, camera, target)
            windings = frame.windings()
            counts = [0, 0]
            for n, winding in enumerate(windings):
                asked = frame.asked(n)
                if asked is None or abs(signed_distance(asked)) < 0.002:
                    continue
                inside = signed_distance(asked) > 0
                counts[inside] += 1
                self.assertEqual(winding, 1 if inside else 0, f"{name}, pixel {n % WIDTH}, {n // WIDTH}")
            self.assertGreater(min(counts), 500, name)

    def test_the_blurred_mask_fades_over_a_metre_across_the_mesh(self):
        context = moderngl.create_standalone_context(backend="egl")
        frame = Frame(context, *self.VIEWS["from outside"])
        shares = frame.shares(frame.windings())
        errors = []
        for n, share in enumerate(shares):
            asked = frame.asked(n)
            on_floor = asked is not None and frame.shown[4 * n + 2] < 0.001
            if not on_floor or frame.shown[4 * n + 3] > 15:
                continue
            expected = min(max(0.5 + signed_distance(asked) / SOFT_M, 0), 1)
            if 0.02 < expected < 0.98:
                errors.append(abs(share - expected))
        fading = sum(1 for share in shares if 0.1 < share < 0.9)
        self.assertGreater(fading, 500)
        self.assertGreater(len(errors), 1000)
        self.assertLess(sum(errors) / len(errors), 0.06)
        print(f"mask blurred: mean error {sum(errors) / len(errors):.3f}, {fading} pixels fade")


AMBIENT = """#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Numbers { float numbers[]; };
layout(binding = 0) uniform sampler3D volume0;
layout(binding = 1) uniform sampler3D volume1;
layout(binding = 2) uniform sampler3D volume2;
layout(binding = 3) uniform sampler2D tile_texture;
layout(binding = 4) uniform sampler2D places;   // and the distance
layout(binding = 5) uniform sampler2D normals;
layout(rgba32f, binding = 0) writeonly uniform image2D ambient;
layout(rgba32f, binding = 1) writeonly uniform image2D surface;
uniform int step;  // pixels of the picture a texel of the buffer
#define DRTV_FETCH(k, uvw) (k == 0 ? textureLod(volume0, uvw, 0.0) : k == 1 ? textureLod(volume1, uvw, 0.0) : textureLod(volume2, uvw, 0.0))
#define DRTV_FETCH_TILE(column) texelFetch(tile_texture, column, 0).xy
// HERE
vec3 three(int n) { return vec3(numbers[n], numbers[n + 1], numbers[n + 2]); }
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec4 place = texelFetch(places, at * step, 0);
    vec3 normal = texelFetch(normals, at * step, 0).xyz;
    DrtvVolume volume = DrtvVolume(three(0), three(3), three(6), three(9), three(12), numbers[15], int(numbers[16]), int(numbers[17]));
    DrtvTiles tiles = DrtvTiles(vec2(numbers[18], numbers[19]), numbers[20], numbers[21]);
    DrtvColours far = DrtvColours(three(22), three(25), three(28), three(31));
    DrtvColours outdoors = drtv_outdoors(volume, tiles, far, place.xyz);
    vec3 colour = place.w > 0.0 ? drtv_ambient(DRTV_ACCURATE, outdoors, far, 0.0, normal) : vec3(0.0);
    imageStore(ambient, at, vec4(colour, 0.0));
    imageStore(surface, at, vec4(normal, place.w));
}
"""
UPSAMPLE = """#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D ambient;
layout(binding = 1) uniform sampler2D surface;
layout(binding = 4) uniform sampler2D places;
layout(binding = 5) uniform sampler2D normals;
layout(rgba32f, binding = 0) writeonly uniform image2D result;
uniform int step;
uniform bool plainly;
#define DRTV_FETCH_MASK(pixel) vec2(0.0)
#define DRTV_FETCH_AMBIENT(pixel) texelFetch(ambient, clamp(pixel, ivec2(0), textureSize(ambient, 0) - 1), 0)
#define DRTV_FETCH_SURFACE(pixel) texelFetch(surface, clamp(pixel, ivec2(0), textureSize(surface, 0) - 1), 0)
// HERE
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    vec2 at = vec2(pixel) / float(step) + 0.5;
    vec3 colour = drtv_upsampled(at, texelFetch(normals, pixel, 0).xyz, texelFetch(places, pixel, 0).w);
    if (plainly)
        colour = textureLod(ambient, at / vec2(textureSize(ambient, 0)), 0.0).xyz;
    imageStore(result, pixel, vec4(colour, 0.0));
}
"""


class Scene(unittest.TestCase):
    """A frame of the yard: places, normals and distances come from the C++, and so does the right light."""

    @classmethod
    def setUpClass(cls):
        cls.context = context = moderngl.create_standalone_context(backend="egl")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([WRITE_FRAME, folder], check=True)

            def bytes_of(name):
                with open(os.path.join(folder, name), "rb") as file:
                    return file.read()

            about = json.loads(bytes_of("frame.json"))
            cls.size = tuple(about["size"])
            cls.expected = array.array("f", bytes_of("expected"))
            pixels = array.array("f", bytes_of("pixels"))
            cls.kept = [
                context.texture3d(tuple(about["texels"]), 4, bytes_of(f"texels{k}"), alignment=1, dtype="f2")
                for k in range(3)
            ]
            cls.kept.append(context.texture((about["tiles"],) * 2, 2, bytes_of("tiles"), dtype="f4"))
            cls.numbers = context.buffer(bytes_of("numbers"))
        cls.distances = pixels[6::8]
        places, normals = array.array("f"), array.array("f")
        for n in range(0, len(pixels), 8):
            places.extend((*pixels[n : n + 3], pixels[n + 6]))
            normals.extend((*pixels[n + 3 : n + 6], 0))
        cls.kept += [context.texture(cls.size, 4, data.tobytes(), dtype="f4") for data in (places, normals)]
        for texture in cls.kept[:3]:
            texture.filter, texture.repeat_x = (moderngl.LINEAR, moderngl.LINEAR), False
            texture.repeat_y = texture.repeat_z = False

    def shader(self, source, include):
        with open(os.path.join(SHADERS, include), encoding="utf-8") as file:
            return self.context.compute_shader(source.replace("// HERE", file.read()))

    def image(self, size):
        texture = self.context.texture(size, 4, dtype="f4")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False
        return texture

    def ambient(self, step):
        """The ambient buffer of every step-th pixel, and what it shows."""
        size = tuple(n // step for n in self.size)
        ambient, surface = self.image(size), self.image(size)
        for unit, texture in enumerate(self.kept):
            texture.use(unit)
        self.numbers.bind_to_storage_buffer(0)
        ambient.bind_to_image(0, read=False, write=True)
        surface.bind_to_image(1, read=False, write=True)
        shader = self.shader(AMBIENT, "drtv_ambient.glsl")
        shader["step"].value = step
        shader.run(-(-size[0] // 8), -(-size[1] // 8))
        return ambient, surface

    def upsampled(self, step, plainly):
        ambient, surface = self.ambient(step)
        result = self.image(self.size)
        ambient.use(0)
        surface.use(1)
        self.kept[4].use(4)
        self.kept[5].use(5)
        result.bind_to_image(0, read=False, write=True)
        shader = self.shader(UPSAMPLE, "drtv_passes.glsl")
        shader["step"].value, shader["plainly"].value = step, plainly
        shader.run(self.size[0] // 8, self.size[1] // 8)
        return array.array("f", result.read())

    def errors(self, found):
        """By pixel that shows a surface: of the largest channel, over the mean light or the pixel's own."""
        lights = [max(self.expected[4 * n : 4 * n + 3]) for n, d in enumerate(self.distances) if d > 0]
        mean, errors = sum(lights) / len(lights), []
        for n, distance in enumerate(self.distances):
            if distance == 0:
                continue
            right, shown = self.expected[4 * n : 4 * n + 3], found[4 * n : 4 * n + 3]
            errors.append(max(abs(a - b) for a, b in zip(right, shown)) / max(mean, *right))
        return errors

    def test_the_frame_is_what_the_cpp_finds(self):
        ambient, _ = self.ambient(1)
        errors = self.errors(array.array("f", ambient.read()))
        self.assertGreater(len(errors), 30000)
        # Filtered by weights of 8 bits between texels that differ by their whole value.
        self.assertLess(max(errors), 2 / 255)
        self.assertLess(sum(errors) / len(errors), 0.2 / 255)

    def test_the_frame_has_volume_and_distance(self):
        """Else the tests here would show less than they say."""
        numbers = array.array("f", self.numbers.read())
        half = [1 / (2 * scale) for scale in numbers[3:6]]
        places = array.array("f", self.kept[4].read())
        inside = outside = 0
        for n in range(0, len(places), 4):
            if places[n + 3] > 0:
                is_inside = all(abs(p) < h for p, h in zip(places[n : n + 3], half))
                inside, outside = inside + is_inside, outside + (not is_inside)
        self.assertGreater(min(inside, outside), 4000)

    def test_a_smaller_buffer_keeps_edges(self):
        for step, mean_limit, worst_limit in ((2, 0.003, 0.02), (4, 0.006, 0.05)):
            errors = sorted(self.errors(self.upsampled(step, False)))
            plain = self.errors(self.upsampled(step, True))
            mean, worst = sum(errors) / len(errors), errors[int(0.98 * len(errors))]
            self.assertLess(mean, mean_limit)
            self.assertLess(worst, worst_limit)
            self.assertGreater(sum(plain) / len(plain), 2 * mean, "a filter that knows no surfaces is worse")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
