"""The shaders find what the C++ finds: GLSL, HLSL by way of SPIR-V, and WGSL on Dawn, all on software drivers. Usage:
SCRIPT CASES_PROGRAM SHADER_FOLDER WEBGPU_MODULE (npm's webgpu: its index.js)"""
import array
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import moderngl
import passes_twin

CASES_PROGRAM, SHADERS, WEBGPU_MODULE = (os.path.abspath(path) for path in sys.argv[1:4])
VULKAN_DRIVER = "/usr/lib/chromium/vk_swiftshader_icd.json"
HERE = os.path.dirname(os.path.abspath(__file__))
COMPONENTS = {
    "rgba8unorm": (4, "f1"),
    "rgba16float": (4, "f2"),
    "rg32float": (2, "f4"),
    "rgba32float": (4, "f4"),
}
ARITHMETIC = 1e-5  # of values around 1: sums of a dozen floats
# Drivers filter 8-bit texels with weights of 8 bits. A code is scale / 255, near the scale twice that by square roots;
# four weights add up to as much as this.
FILTERED = 1 / 255
GAIN = 1.6
NOT_LIGHT = (4, 6, 7, 8, 9, 10, 11)  # of a point's numbers: the sky's factor, two of the views, weights


def read(path, mode="r"):
    with open(path, mode, **({} if "b" in mode else {"encoding": "utf-8"})) as file:
        return file.read()


def floats(path):
    return array.array("f", read(path, "rb"))


class Case:
    def __init__(self, folder):
        self.folder = folder
        self.about = json.loads(read(os.path.join(folder, "case.json")))
        self.expected = floats(os.path.join(folder, "expected"))

    @property
    def harness(self):
        return (
            "harness_passes" if "mask" in [listed["file"] for listed in self.about["textures"]] else "harness"
        )

    @property
    def include(self):
        return "drtv_passes" if self.harness == "harness_passes" else "drtv_ambient"

    def defines(self, manual):
        flags = {"MANUAL": manual, "ATLAS": self.about["atlas"], "REPEAT": self.about["repeat"]}
        return "".join(f"#define {name}\n" for name, holds in flags.items() if holds)

    def filtered_bound(self):
        if self.harness == "harness_passes":
            return ARITHMETIC
        scale, encoding = floats(os.path.join(self.folder, "numbers"))[15:17]
        return FILTERED * GAIN * (scale if encoding == 0 else 2 * scale if encoding == 1 else 1)

    def bytes_of(self, name):
        return read(os.path.join(self.folder, name), "rb")


class Gpu:
    def __init__(self):
        self.context = moderngl.create_standalone_context(backend="egl")

    def results(self, source, case):
        context, about = self.context, case.about
        shader = context.compute_shader(source)
        kept = []
        for unit, listed in enumerate(about["textures"]):
            make = context.texture3d if len(listed["size"]) == 3 else context.texture
            count, kind = COMPONENTS[listed["format"]]
            texture = make(
                tuple(listed["size"]), count, case.bytes_of(listed["file"]), alignment=1, dtype=kind
            )
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = about["repeat"]
            if len(listed["size"]) == 3:
                texture.repeat_z = about["repeat"]
            texture.use(unit)
            kept.append(texture)
        points = context.buffer(case.bytes_of("points"))
        numbers = context.buffer(case.bytes_of("numbers"))
        results = context.buffer(reserve=4 * len(case.expected))
        for binding, buffer in enumerate((points, numbers, results)):
            buffer.bind_to_storage_buffer(binding)
        shader.run(group_x=(len(case.expected) // 16 + 63) // 64)
        found = array.array("f", results.read())
        for thing in [shader, points, numbers, results, *kept]:
            thing.release()
        return found


def glsl_source(include, case, manual):
    text = read(os.path.join(HERE, f"{case.harness}.glsl")).replace("// HERE", include)
    return "#version 450\n" + case.defines(manual) + text


def hlsl_source(include, case, manual, folder):
    """By glslang to SPIR-V, which is valid, and by spirv-cross to GLSL; and to MSL."""
    text = case.defines(manual) + read(os.path.join(HERE, f"{case.harness}.hlsl")).replace("// HERE", include)
    hlsl, spirv = os.path.join(folder, "harness.hlsl"), os.path.join(folder, "harness.spv")
    with open(hlsl, "w", encoding="utf-8") as file:
        file.write(text)
    command = ["glslangValidator", "-D", "-e", "main", "-S", "comp", "-V", "-o", spirv, hlsl]
    compiled = subprocess.run(command, capture_output=True, text=True)
    if compiled.returncode != 0:
        raise AssertionError(compiled.stdout)
    subprocess.run(["spirv-val", spirv], check=True)
    metal = subprocess.run(["spirv-cross", spirv, "--msl"], capture_output=True, text=True, check=True)
    if "kernel void" not in metal.stdout:
        raise AssertionError(metal.stdout)
    glsl = subprocess.run(
        ["spirv-cross", spirv, "--version", "450"], capture_output=True, text=True, check=True
    ).stdout
    return with_bindings(glsl)


def with_bindings(glsl):
    """Bindings of the harness: samplers and buffers by name."""
    units = {"volume0": 0, "volume1": 1, "volume2": 2, "tile_texture": 3}
    units |= {"mask_texture": 0, "ambient_texture": 1, "surface_texture": 2}
    buffers = {"points": 0, "numbers": 1, "results": 2}

    def sampler(match):
        unit = next(unit for name, unit in units.items() if name in match[0])
        return f"layout(binding = {unit}) {match[0][match[0].index('uniform'):]}"

    glsl = re.sub(r"(layout\(binding = \d+\) )?uniform sampler[23]D \w+;", sampler, glsl)

    def buffer(match):
        binding = next(binding for name, binding in buffers.items() if match[2].startswith(name))
        return f"layout(binding = {binding}, std430) {match[1]}{match[2]}"

    return re.sub(
        r"layout\(binding = \d+, std430\) ((?:readonly |writeonly )?buffer \w+\n\{[^}]*\} )(\w+)",
        buffer,
        glsl,
    )


class Gl:
    """GLSL, and HLSL by way of SPIR-V."""

    def __init__(self, folder):
        self.gpu, self.folder = Gpu(), folder

    def all_results(self, language, jobs):
        for include, case, manual in jobs:
            if language == "glsl":
                yield self.gpu.results(glsl_source(include, case, manual), case)
            else:
                yield self.gpu.results(hlsl_source(include, case, manual, self.folder), case)


class Dawn:
    def __init__(self, folder):
        self.folder = folder

    def all_results(self, language, jobs):
        listed = []
        for n, (include, case, manual) in enumerate(jobs):
            flags = {"MANUAL": manual, "ATLAS": case.about["atlas"], "REPEAT": case.about["repeat"]}
            harness = read(os.path.join(HERE, f"{case.harness}.{language}"))
            consts = "".join(f"const {name}: bool = {str(holds).lower()};\n" for name, holds in flags.items())
            source, out = (os.path.join(self.folder, f"{n}.{ending}") for ending in ("wgsl", "results"))
            with open(source, "w", encoding="utf-8") as file:
                file.write(consts + harness.replace("// HERE", include))
            listed.append({"source": source, "case": case.folder, "out": out})
        path = os.path.join(self.folder, "jobs.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(listed, file)
        environment = dict(
            os.environ,
            VK_DRIVER_FILES=VULKAN_DRIVER,
            VK_ICD_FILENAMES=VULKAN_DRIVER,
            WEBGPU_MODULE=WEBGPU_MODULE,
        )
        subprocess.run(["node", os.path.join(HERE, "run_wgsl.mjs"), path], check=True, env=environment)
        for job in listed:
            yield floats(job["out"])


def with_wrong_constant(include, number):
    return re.sub(rf"(?<![\d.]){re.escape(number)}(?![\d.])", str(float(number) * 1.01 + 0.001), include)


def error_of(found, case):
    """Of each point's numbers: the largest, in units of what is expected, but at least of the light's magnitude, or of 1."""
    light = case.about.get("magnitude", 1)
    least = [1 if slot in NOT_LIGHT else light for slot in range(16)]
    return max(
        abs(a - b) / max(least[n % 16], abs(b))
        for n, (a, b) in enumerate(zip(found, case.expected, strict=True))
    )


class Shaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        subprocess.run(
            [CASES_PROGRAM, cls.folder.name, os.environ.get("DRTV_SHADER_POINTS", "6000")], check=True
        )
        passes_twin.make_case(os.path.join(cls.folder.name, "passes"))
        cls.cases = {
            name: Case(os.path.join(cls.folder.name, name)) for name in sorted(os.listdir(cls.folder.name))
        }
        cls.scratch = tempfile.TemporaryDirectory()
        gl = Gl(cls.scratch.name)
        cls.drivers = {"glsl": gl, "hlsl": gl, "wgsl": Dawn(cls.scratch.name)}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()
        cls.scratch.cleanup()

    @staticmethod
    def include(language, name="drtv_ambient"):
        return read(os.path.join(SHADERS, f"{name}.{language}"))

    def test_every_case_in_every_language(self):
        for language, driver in self.drivers.items():
            asked = [(name, manual) for name in self.cases for manual in (True, False)]
            jobs = [
                (self.include(language, self.cases[name].include), self.cases[name], manual)
                for name, manual in asked
            ]
            worst = {True: 0, False: 0}
            for (name, manual), found in zip(asked, driver.all_results(language, jobs)):
                case = self.cases[name]
                error = error_of(found, case)
                worst[manual] = max(worst[manual], error)
                with self.subTest(language=language, case=name, manual=manual):
                    self.assertLess(error, ARITHMETIC if manual else case.filtered_bound())
            print(f"{language}: by hand {worst[True]:.2g}, filtered {worst[False]:.2g}")

    def test_glsl_compiles_in_every_version_that_games_use(self):
        body = read(os.path.join(HERE, "fragment.glsl")).replace("// HERE", self.include("glsl"))
        for version in ("300 es", "330", "450"):
            path = os.path.join(self.scratch.name, "fragment.frag")
            with open(path, "w", encoding="utf-8") as file:
                file.write(f"#version {version}\n{body}")
            told = subprocess.run(["glslangValidator", path], capture_output=True, text=True)
            self.assertEqual(told.returncode, 0, f"{version}: {told.stdout}")

    def test_a_wrong_constant_shows(self):
        for language, driver in self.drivers.items():
            for names in (("rgba16f", "rgba8-literal-atlas", "clipped", "bright"), ("passes",)):
                cases = [self.cases[name] for name in names]
                include = self.include(language, cases[0].include)
                numbers = sorted(set(re.findall(r"\b\d+\.\d+\b", re.sub(r"//.*", "", include))))
                jobs = [
                    (with_wrong_constant(include, number), case, True) for number in numbers for case in cases
                ]
                results = driver.all_results(language, jobs)
                errors = [error_of(found, case) for (_, case, _), found in zip(jobs, results)]
                self.assertGreater(len(numbers), 5)
                for n, number in enumerate(numbers):
                    with self.subTest(language=language, include=cases[0].include, number=number):
                        self.assertGreater(max(errors[n * len(cases) :][: len(cases)]), 10 * ARITHMETIC)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
