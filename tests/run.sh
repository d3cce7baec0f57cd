#!/usr/bin/env bash
# Fresh Debian 12 -> packages, build, every test, a minute of each fuzz target. Warnings are errors.
#   tests/run.sh            what CI runs
#   tests/run.sh --asan     the same under the address and undefined-behaviour sanitizers
#   tests/run.sh --tsan     the same under the thread sanitizer
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=ci
case ${1:-} in
  "") ;;
  --asan) preset=asan ;;
  --tsan) preset=tsan ;;
  *) echo "run.sh: unknown option $1" >&2; exit 2 ;;
esac

"$source_dir/deploy/install_packages.sh" --tests
cd "$source_dir"
tests/style.py
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" --parallel "$(nproc)"
if [[ $preset == ci ]]; then
  tests/fuzz/run.sh
fi
