#!/bin/sh
# format/ installs, and a program of ten lines finds and links it with no other package. Usage: run.sh FORMAT_FOLDER CONSUMER_FOLDER GOLDEN_FILE
set -eu
format=$1 consumer=$2 golden=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }; }

run cmake -S "$format" -B "$work/format" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0
run ninja -C "$work/format" -j1
run cmake --install "$work/format" --prefix "$work/prefix"
run cmake -S "$consumer" -B "$work/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix"
run ninja -C "$work/consumer"

# It looks for drtv, and drtv for the zstd library.
packages=$(sed -n 's/^\([A-Za-z0-9_-]*\)_DIR:PATH=.*/\1/p' "$work/consumer/CMakeCache.txt" | sort | tr '\n' ' ')
[ "$packages" = "drtv zstd " ] || { echo "the consumer looks for packages: $packages"; exit 1; }
for library in $(objdump -p "$work/consumer/consumer" | sed -n 's/^ *NEEDED *\([^ ]*\)$/\1/p'); do
    case $library in
        libzstd.so.* | libstdc++.so.* | libm.so.* | libgcc_s.so.* | libc.so.* | ld-linux*) ;;
        *) echo "the consumer is linked to $library"; exit 1 ;;
    esac
done
for file in bin/drtv include/drtv/version.h include/drtv/view.h include/drtv/relight.h share/doc/drtv_format/SPEC.md; do
    [ -e "$work/prefix/$file" ] || { echo "$file is not installed"; exit 1; }
done

# Over a plane of albedo 1/2: what comes from below is the albedo.
output=$("$work/consumer/consumer" "$golden")
[ "$output" = "2 probes, from below 0.5000" ] || { echo "the consumer says: $output"; exit 1; }
echo "$output"
