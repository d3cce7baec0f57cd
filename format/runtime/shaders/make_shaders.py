#!/usr/bin/env python3
"""Makes .glsl, .hlsl and .wgsl of drtv_ambient.shader and drtv_passes.shader. Usage: make_shaders.py [--check]

The one text is plain enough that words alone tell the languages apart: functions, structs, constants, locals (`const`
where they do not change), if, for, return; no arrays, no out parameters, no choice by `?`. --check only says whether
they are up to date.
"""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
NAMES = ("drtv_ambient", "drtv_passes")
FETCHES = ("DRTV_FETCH", "DRTV_FETCH_TILE", "DRTV_FETCH_AMBIENT", "DRTV_FETCH_SURFACE", "DRTV_FETCH_MASK")
TYPES = r"float|int|bool|vec2|vec3|vec4|ivec2|Drtv\w+"

HLSL_WORDS = {
    "vec2": "float2",
    "vec3": "float3",
    "vec4": "float4",
    "ivec2": "int2",
    "fract": "frac",
    "mix": "lerp",
}
WGSL_TYPES = {
    "float": "f32",
    "int": "i32",
    "vec2": "vec2<f32>",
    "vec3": "vec3<f32>",
    "vec4": "vec4<f32>",
    "ivec2": "vec2<i32>",
}


def guarded(name, text):
    return f"#ifndef {name.upper()}\n#define {name.upper()}\n{text}#endif\n"


def glsl(name, text):
    # In ES a constant's value is known when it is compiled.
    return guarded(name, re.sub(r"^(\s+)const ", r"\1", text, flags=re.MULTILINE))


def hlsl(name, text):
    for word, other in HLSL_WORDS.items():
        text = re.sub(rf"\b{word}\b", other, text)
    text = re.sub(r"^const (\w+ DRTV_)", r"static const \1", text, flags=re.MULTILINE)
    return guarded(name, text)


def wgsl_type(name):
    return WGSL_TYPES.get(name, name)


def wgsl_function(match):
    result, name, parameters = match.groups()
    listed = [parameter.split() for parameter in parameters.split(",")]
    return f"fn {name}({', '.join(f'{word}: {wgsl_type(kind)}' for kind, word in listed)}) -> {wgsl_type(result)} {{"


def wgsl(_, text):
    code, out = text.split("\n"), []
    in_struct = False
    for line in code:
        line, slashes, comment = line.partition("//")
        if re.match(r"struct \w+ \{", line):
            in_struct = True
        elif in_struct:
            in_struct = not line.startswith("}")
            line = re.sub(rf"^(\s+)({TYPES}) (\w+);", lambda m: f"{m[1]}{m[3]}: {wgsl_type(m[2])},", line)
            line = line.replace("};", "}")
        else:
            line = re.sub(rf"^({TYPES}) (\w+)\(([^)]*)\) \{{", wgsl_function, line)
            line = re.sub(
                rf"\bconst ({TYPES}) (\w+) =",
                lambda m: f"{'const' if m.start() == 0 else 'let'} {m[2]}: {wgsl_type(m[1])} =",
                line,
            )
            line = re.sub(
                rf"(^\s+|\()({TYPES}) (\w+)( =|;)",
                lambda m: f"{m[1]}var {m[3]}: {wgsl_type(m[2])}{m[4]}",
                line,
            )
            for word in ("vec2", "vec3", "vec4", "ivec2", "float", "int"):
                line = re.sub(rf"\b{word}\(", f"{wgsl_type(word)}(", line)
            for fetch in FETCHES:
                line = re.sub(rf"\b{fetch}\(", f"{fetch.lower()}(", line)
        out.append(line + slashes + comment)
    return "\n".join(out)


def main():
    stale = []
    for name in NAMES:
        with open(os.path.join(HERE, f"{name}.shader"), encoding="utf-8") as file:
            text = file.read()
        said = f"// Made by make_shaders.py of {name}.shader: change it there. SPDX-License-Identifier: MIT\n"
        for ending, translate in (("glsl", glsl), ("hlsl", hlsl), ("wgsl", wgsl)):
            path = os.path.join(HERE, f"{name}.{ending}")
            made = said + translate(name, text)
            if sys.argv[1:] == ["--check"]:
                with open(path, encoding="utf-8") as file:
                    stale += [path] if file.read() != made else []
                continue
            with open(path, "w", encoding="utf-8") as file:
                file.write(made)
    if stale:
        raise SystemExit(f"not of the present .shader files, run make_shaders.py: {', '.join(stale)}")


if __name__ == "__main__":
    main()
