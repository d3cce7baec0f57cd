#!/bin/sh
# format/ configures, builds and runs by itself, and needs no package but zstd. Usage: builds_alone.sh FORMAT_FOLDER
set -eu
source=$1
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT

cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }
ninja -C "$build" -j1 >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }

packages=$(sed -n 's/^\([A-Za-z0-9_-]*\)_DIR:PATH=.*/\1/p' "$build/CMakeCache.txt" | sort | tr '\n' ' ')
[ "$packages" = "zstd " ] || { echo "format/ looks for packages: $packages; it may look for zstd only"; exit 1; }

drtv=$(find "$build" -name drtv -type f -perm -u+x)
[ -n "$drtv" ] || { echo "the build made no drtv"; exit 1; }

# Everything linked directly, by the linker's own record.
libraries=$(objdump -p "$drtv" | sed -n 's/^ *NEEDED *\([^ ]*\)$/\1/p')
for library in $libraries; do
    case $library in
        libzstd.so.* | libstdc++.so.* | libm.so.* | libgcc_s.so.* | libc.so.* | ld-linux*) ;;
        *) echo "drtv is linked to $library"; exit 1 ;;
    esac
done

"$drtv" --version
