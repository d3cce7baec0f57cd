#!/bin/sh
# format/ is all that a game needs: copied to an empty folder, it configures and builds by itself, static, shared and without
# zstd, by both compilers. Usage: builds_alone.sh FORMAT_FOLDER GOLDEN_FOLDER
set -eu
source=$1 golden=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }
run() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "failed: $*"; }; }
# Everything linked directly, by the linker's own record.
libraries_of() { objdump -p "$1" | sed -n 's/^ *NEEDED *\([^ ]*\)$/\1/p' | sort | tr '\n' ' '; }
packages_of() { sed -n 's/^\([A-Za-z0-9_-]*\)_DIR:PATH=.*/\1/p' "$work/$1/CMakeCache.txt" | sort | tr '\n' ' '; }

cp -r "$source" "$work/format"
mkdir "$work/elsewhere"
cd "$work/elsewhere"

# build NAME COMPILER OPTION... -- TARGET...
build() {
    name=$1 compiler=$2
    shift 2
    options=
    while [ "$1" != -- ]; do options="$options $1"; shift; done
    shift
    # shellcheck disable=SC2086
    run cmake -S "$work/format" -B "$work/$name" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_CXX_FLAGS_DEBUG=-O0 $options
    run ninja -C "$work/$name" -j1 "$@"
}


libraries="drtv_format drtv_runtime"

build whole g++-12 -- all
[ "$(packages_of whole)" = "CLI11 OPENSSL_INCLUDE nlohmann_json tl-expected zstd " ] || fail "format/ looks for packages: $(packages_of whole)"
for library in $(libraries_of "$work/whole/bin/drtv"); do
    case $library in
        libcrypto.so.* | libzstd.so.* | libstdc++.so.* | libm.so.* | libgcc_s.so.* | libc.so.* | ld-linux*) ;;
        *) fail "drtv is linked to $library" ;;
    esac
done
"$work/whole/bin/drtv" --version

# Without what the tool needs the libraries build all the same, and one line says so.
run cmake -S "$work/format" -B "$work/no_tool" -G Ninja -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DDRTV_STB_HEADERS=NO
grep -q "The drtv tool is left out: CLI11, stb not found" "$work/log" || { cat "$work/log"; fail "nothing says that the tool is left out"; }
# shellcheck disable=SC2086
run ninja -C "$work/no_tool" -n $libraries
[ -z "$(ninja -C "$work/no_tool" -t query drtv 2>/dev/null)" ] || fail "the tool is built without what it needs"

build shared clang++-14 -DBUILD_SHARED_LIBS=ON -- all
[ -n "$(find "$work/shared" -name 'libdrtv_format.so*')" ] || fail "BUILD_SHARED_LIBS made no shared library"
# Installed ones find each other, wherever the folder stands.
run cmake --install "$work/shared" --prefix "$work/prefix"
mv "$work/prefix" "$work/moved"
run "$work/moved/bin/drtv" --version
ldd "$work/moved/lib/libdrtv_runtime.so" | grep -q "libdrtv_format.so.* => $work/moved" || fail "libdrtv_runtime does not find libdrtv_format"

for compiler in g++-12 clang++-14; do
    # shellcheck disable=SC2086
    CXXFLAGS="-fno-exceptions -fno-rtti" build "plain-$compiler" "$compiler" -DDRTV_ZSTD=OFF -- $libraries
    case $(packages_of "plain-$compiler") in *zstd*) fail "without zstd it looks for it" ;; esac
done

# A game that maps raw files: linked to no compressor, whether the library knows one or not.
cat >game.cpp <<'GAME'
#include <drtv/read.h>
#include <drtv/relight.h>
#include <drtv/view.h>
#include <cstdio>
#include <vector>

int main(int, char** argv) {
    alignas(16) static std::uint8_t bytes[1 << 20];
    std::FILE* file = std::fopen(argv[1], "rb");
    const std::size_t size = file == nullptr ? 0 : std::fread(bytes, 1, sizeof bytes, file);
    drtv::SectorView sector;
    const drtv::ReadStatus status = drtv::open_sector({bytes, size}, sector);
#ifdef READ
    drtv::Sector read;
    std::puts(drtv::read_sector({bytes, size}, read).message.c_str());
#endif
    if (!status.ok())
        return 1;
    drtv::SceneLight light;
    light.sky = drtv::constant_sky({1, 1, 1});
    const drtv::BasisColours colours = drtv::relight(sector, 0, light);
    std::printf("%zu probes, from below %.4f\n", sector.probe_count, static_cast<double>(colours[3][0]));
}
GAME
game() {
    compiler=$1 built=$2 program=$3
    shift 3
    run "$compiler" -std=c++20 -Wall -Wextra -Wpedantic -Werror -fno-exceptions -fno-rtti "$@" \
        -I "$work/format/include" -I "$work/format/runtime/include" game.cpp -o "$program" \
        -L "$work/$built" -ldrtv_runtime -ldrtv_format
}
for compiler in g++-12 clang++-14; do
    for built in whole "plain-$compiler"; do
        game "$compiler" "$built" opens
        case $(libraries_of opens) in *zstd*) fail "a game that opens raw files is linked to zstd" ;; esac
        output=$(./opens "$golden/format_1_0.drtv")
        [ "$output" = "2 probes, from below 0.5000" ] || fail "the game says: $output"
    done
    # Without zstd a compressed file is refused with a sentence.
    game "$compiler" "plain-$compiler" reads -DREAD
    output=$(./reads "$golden/format_1_0_zstd.drtv" || true)
    case $output in
        *"is compressed, and this library was built without zstd"*) ;;
        *) fail "a compressed file, read without zstd: $output" ;;
    esac
done
