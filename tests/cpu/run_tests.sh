#!/usr/bin/env bash
# The tests of placement, trace, bake and reuse on QEMU's CPU instead of this one (some 200 times slower).
#   tests/cpu/run_tests.sh FOLDER_OF_TESTS [--gtest_...]
set -euo pipefail

folder=${1:?"usage: run_tests.sh FOLDER_OF_TESTS, as build/ci/tests"}
shift
# Fewer rays at edges and vertices, and fewer edits one after the other, than on a real CPU.
export DRTV_LEAK_RAYS=${DRTV_LEAK_RAYS:-2000} DRTV_TEST_EDITS=${DRTV_TEST_EDITS:-2}
shards=$(nproc)
status=0
for test in placement_test trace_test bake_test reuse_test; do
  pids=()
  for shard in $(seq 0 $((shards - 1))); do
    GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$shard qemu-x86_64 -cpu max "$folder/$test" --gtest_brief=1 "$@" &
    pids+=($!)
  done
  for pid in "${pids[@]}"; do
    wait "$pid" || status=1
  done
done
exit "$status"
