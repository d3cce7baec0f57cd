"""An interior's mask in rendered frames: drawn, blurred, and held against the geometry. Usage: SCRIPT SHADER_FOLDER"""
import array
import math
import os
import sys
import unittest

import moderngl

SHADERS = os.path.abspath(sys.argv[1])
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
