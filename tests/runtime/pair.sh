#!/bin/sh
# The amalgamated pair: small, without warnings, without exceptions or RTTI, by three compilers; and the same bits from AVX2, SSE2,
# plain C++, NEON and WebAssembly. Usage: pair.sh SOURCE_FOLDER WRITE_SECTORS
set -eu
source=$1 write_sectors=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }
run() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "failed: $*"; }; }

run python3 -B "$source/format/amalgamate.py" "$work/pair"
cp "$source/tests/runtime/same_bits.cpp" "$work/pair"
cd "$work/pair"
mkdir sectors
files=$("$write_sectors" sectors)
flags="-std=c++20 -Wall -Wextra -Wpedantic -Wshadow -Werror -fno-exceptions -fno-rtti"

# 64 KB of code, optimised for size.
# shellcheck disable=SC2086
run g++-12 $flags -Os -c drtv_runtime.cpp -o small.o
code=$(size -A small.o | awk '/^\.text/ { sum += $2 } END { print sum }')
echo "$code bytes of code"
[ "$code" -le 65536 ] || fail "the pair has $code bytes of code, more than 64 KB"
# It has no state of its own.
state=$(size -A small.o | awk '/^\.(data|bss)/ && !/rel\.ro/ { sum += $2 } END { print sum + 0 }')
[ "$state" -eq 0 ] || fail "the pair has $state bytes of global state"

expected=
# same NAME RUNNER COMPILER OPTION...
same() {
    name=$1 runner=$2
    shift 2
    # shellcheck disable=SC2086
    run "$@" $flags same_bits.cpp drtv_runtime.cpp -o program.js
    # shellcheck disable=SC2086
    output=$($runner ./program.js $files 2>&1) || fail "$name: $(echo "$output" | tail -c 2000)"
    [ -n "$expected" ] || { expected=$output; echo "$output"; }
    [ "$output" = "$expected" ] || fail "$name gives other bits:
$output"
    echo "$name: the same bits"
}
same "AVX2" "" g++-12 -O2
same "AVX2 and FMA allowed" "" g++-12 -O2 -march=haswell
same "SSE2" "" g++-12 -O2 -DDRTV_NO_AVX2
same "plain C++" "" g++-12 -O1 -DDRTV_SCALAR
same "clang, AVX2 and FMA allowed" "" clang++-14 -O2 -march=haswell
same "clang, plain C++" "" clang++-14 -O1 -DDRTV_SCALAR
same "NEON" qemu-aarch64 aarch64-linux-gnu-g++ -O2 -static
export NODE_PATH=/usr/share/nodejs  # where Debian keeps what emscripten asks for
same "WebAssembly" node em++ -O2 -sSINGLE_FILE=1 -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1
if g++-12 -std=c++20 -ffast-math -fsyntax-only drtv_runtime.cpp 2>log; then fail "-ffast-math is not refused"; fi
grep -q "must not be compiled with -ffast-math" log || { cat log; fail "-ffast-math is refused without a reason"; }
