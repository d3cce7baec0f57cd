#!/bin/sh
# format/ installs, and the example finds and links it with no other package, runs over a folder, one without probes, and an empty one.
# Usage: run.sh FORMAT_FOLDER EXAMPLES_FOLDER GOLDEN_FOLDER
set -eu
format=$1 examples=$2 golden=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }
run() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }; }

run cmake -S "$format" -B "$work/format" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0
run ninja -C "$work/format" -j1
run cmake --install "$work/format" --prefix "$work/prefix"
run cmake -S "$examples" -B "$work/examples" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix"
run ninja -C "$work/examples"

# It looks for drtv, and drtv for the zstd library.
packages=$(sed -n 's/^\([A-Za-z0-9_-]*\)_DIR:PATH=.*/\1/p' "$work/examples/CMakeCache.txt" | sort | tr '\n' ' ')
[ "$packages" = "drtv zstd " ] || fail "the example looks for packages: $packages"
for library in $(objdump -p "$work/examples/relight_a_folder" | sed -n 's/^ *NEEDED *\([^ ]*\)$/\1/p'); do
    case $library in
        libzstd.so.* | libstdc++.so.* | libm.so.* | libgcc_s.so.* | libc.so.* | ld-linux*) ;;
        *) fail "the example is linked to $library" ;;
    esac
done
for file in bin/drtv include/drtv/version.h include/drtv/view.h include/drtv/volume.h include/drtv/drtv.h lib/libdrtv.so \
    share/drtv/shaders/drtv_ambient.glsl share/drtv/shaders/drtv_ambient.hlsl share/drtv/shaders/drtv_ambient.wgsl \
    share/doc/drtv_format/SPEC.md share/doc/drtv_format/light.schema.json; do
    [ -e "$work/prefix/$file" ] || fail "$file is not installed"
done

mkdir "$work/sectors" "$work/empty"
cp "$golden/format_1_3.drtv" "$work/sectors"
output=$("$work/examples/relight_a_folder" "$work/sectors")
echo "$output"
case $output in "1 sectors"*"22:00 "*"us, "*"a particle gets"*) ;; *) fail "the example says something else" ;; esac
case $output in *nan* | *inf*) fail "not a number" ;; esac
output=$("$work/examples/relight_a_folder" "$work/empty")
case $output in "0 sectors"*"12:00 "*) ;; *) fail "of an empty folder the example says: $output" ;; esac
# What the GPU's thread sees does not hang on how the two threads run.
for folder in sectors empty; do
    first=$("$work/examples/one_set_of_textures" "$work/$folder")
    second=$("$work/examples/one_set_of_textures" "$work/$folder")
    echo "$first"
    [ "${first##*saw}" = "${second##*saw}" ] || fail "one_set_of_textures saw other texels: $second"
    case $first in *" sectors"*"120 frames until "*" saw "[1-9]*) ;; *) fail "one_set_of_textures says: $first" ;; esac
done
