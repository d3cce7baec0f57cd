#!/usr/bin/env bash
# Builds the fuzz targets (clang, libFuzzer, address and undefined-behaviour sanitizers) and runs each from its seeds and corpus.
#   tests/fuzz/run.sh                        a minute each, two at a time; what tests/run.sh does
#   tests/fuzz/run.sh --runs 10000000        so many executions each (hours for gltf, minutes for the rest)
#   tests/fuzz/run.sh --seconds 600 gltf     ten minutes of one target: gltf, reader, validator, runtime or zstd
#   tests/fuzz/run.sh --update-corpus        afterwards keeps what found new ways, in tests/fuzz/corpus
# A target that crashes, hangs or leaks fails the run; its input lies in build/fuzz/fuzz/found, and is a test case to be.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source_dir=$(cd "$here/../.." && pwd)
limit=-max_total_time=60 update=0 targets=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --seconds) limit=-max_total_time=$2; shift 2 ;;
    --runs) limit=-runs=$2; shift 2 ;;
    --update-corpus) update=1; shift ;;
    gltf | reader | runtime | validator | zstd) targets+=("$1"); shift ;;
    *) echo "run.sh: unknown argument $1" >&2; exit 2 ;;
  esac
done
[[ ${#targets[@]} -gt 0 ]] || targets=(gltf reader validator runtime zstd)

cd "$source_dir"
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
bin=$source_dir/build/fuzz/fuzz
rm -rf "$bin/seeds"
"$bin/fuzz_seeds" "$bin/seeds"
mkdir -p "$bin/found"

declare -A options=([gltf]="-max_len=2500 -dict=$here/gltf.dict" [reader]=-max_len=16384 [runtime]=-max_len=16384 [validator]=-max_len=16384 [zstd]=-max_len=1024)
# Pictures of many megapixels come and go: what the sanitizer holds back of them would be most of the time.
export ASAN_OPTIONS=quarantine_size_mb=8:allocator_release_to_os_interval_ms=-1

fuzz() {
  local target=$1 corpus=$bin/corpus/$1
  mkdir -p "$corpus"
  [[ ! -f $here/corpus/$target.tar.gz ]] || tar -xzf "$here/corpus/$target.tar.gz" -C "$corpus"
  # shellcheck disable=SC2086
  if "$bin/fuzz_$target" "$corpus" "$bin/seeds/$target" ${options[$target]} "$limit" -timeout=60 -rss_limit_mb=4096 \
    -artifact_prefix="$bin/found/$target-" -print_final_stats=1 >"$bin/$target.log" 2>&1; then
    echo "fuzz $target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$bin/$target.log") executions, no fault"
  else
    grep -E "ERROR|SUMMARY|runtime error|Test unit written" "$bin/$target.log" >&2 || tail -20 "$bin/$target.log" >&2
    echo "fuzz $target: FAULT, see $bin/$target.log" >&2
    return 1
  fi
  if [[ $update -eq 1 ]]; then
    rm -rf "$bin/merged/$target"
    mkdir -p "$bin/merged/$target" "$here/corpus"
    # shellcheck disable=SC2086
    "$bin/fuzz_$target" -merge=1 ${options[$target]} "$bin/merged/$target" "$corpus" >>"$bin/$target.log" 2>&1
    tar -C "$bin/merged/$target" --sort=name --mtime=@0 --owner=0 --group=0 -czf "$here/corpus/$target.tar.gz" .
  fi
}

status=0
for ((n = 0; n < ${#targets[@]}; n += 2)); do
  pids=()
  for target in "${targets[@]:n:2}"; do
    fuzz "$target" &
    pids+=($!)
  done
  for pid in "${pids[@]}"; do wait "$pid" || status=1; done
done
exit $status
