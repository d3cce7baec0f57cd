#!/usr/bin/env bash
# Installs from Debian 12 what drtv needs to build, test and run. Idempotent; asks nothing. `--tests` adds what
# only the tests need.
set -euo pipefail

packages=(
  build-essential ca-certificates ccache cmake git ninja-build pkg-config python3
  libcgal-dev libcli11-dev libembree-dev libexpected-dev libfmt-dev libglm-dev libgrpc++-dev libprotobuf-dev
  libspdlog-dev libsqlite3-dev libsqlitecpp-dev libssl-dev libstb-dev libtbb-dev libtinygltf-dev libzstd-dev nlohmann-json3-dev
  protobuf-compiler protobuf-compiler-grpc
)
if [[ "${1:-}" == "--tests" ]]; then
  packages+=(
    black clang-14 clang-format-14 libbenchmark-dev libclang-rt-14-dev libgmock-dev libgtest-dev libxxhash-dev
    emscripten g++-12 g++-aarch64-linux-gnu node-acorn openssl python3-grpcio python3-jsonschema qemu-user shellcheck util-linux
    munge slurm-client slurmctld slurmd
    chromium glslang-tools libegl1 libgl1-mesa-dri libvulkan1 python3-moderngl spirv-cross spirv-tools
  )
  # Debian's, where there are no others.
  command -v npm >/dev/null || packages+=(nodejs npm)
fi

missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null)" == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

sudo=()
if [[ $(id -u) -ne 0 ]]; then
  sudo=(sudo)
fi
echo "installing ${#missing[@]} packages: ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${sudo[@]}" apt-get update -q
"${sudo[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
