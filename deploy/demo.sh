#!/usr/bin/env bash
# Fresh Debian 12 -> packages, build, daemon, a real island baked, validated, pictured.
#   deploy/demo.sh [FOLDER] [--preset draft|console|pc]     FOLDER: for data and results, default ./demo
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
demo_dir=$source_dir/demo
preset=console
while [[ $# -gt 0 ]]; do
  case $1 in
    --preset) preset=${2:?--preset needs a name}; shift 2 ;;
    -h | --help) sed -n '2,3s/^# //p' "${BASH_SOURCE[0]}"; exit 0 ;;
    -*) echo "demo.sh: unknown option $1" >&2; exit 2 ;;
    *) demo_dir=$1; shift ;;
  esac
done
case $preset in
  draft | console | pc) ;;
  *) echo "demo.sh: the preset '$preset' is unknown: there are draft, console and pc" >&2; exit 2 ;;
esac
build_dir=$source_dir/build/release
say() { printf '\n== %s\n' "$*" >&2; }

say "Packages"
"$source_dir/deploy/install_packages.sh"

say "Build (release)"
(cd "$source_dir" && cmake --preset release -DDRTV_BUILD_TESTS=OFF >/dev/null)
cmake --build "$build_dir"
bin=$build_dir/bin

mkdir -p "$demo_dir"
demo_dir=$(cd "$demo_dir" && pwd)

say "Map: Maunga Whau as an island"
PYTHONDONTWRITEBYTECODE=1 python3 "$source_dir/deploy/demo_map/make_demo_map.py" --out "$demo_dir/map" --stats

say "Daemon"
# Port 0: the daemon takes a free one and says which.
"$bin/bakerd" serve --data "$demo_dir/data" --listen 127.0.0.1:0 2>"$demo_dir/bakerd.log" &
daemon=$!
trap 'kill "$daemon" 2>/dev/null; wait "$daemon" 2>/dev/null || true' EXIT
address=
for _ in $(seq 100); do
  address=$(sed -n 's/.*bakerd listens on \([^,]*\),.*/\1/p' "$demo_dir/bakerd.log" | tail -n 1)
  [[ -n $address ]] && break
  kill -0 "$daemon" 2>/dev/null || { cat "$demo_dir/bakerd.log" >&2; exit 1; }
  sleep 0.1
done
[[ -n $address ]] || { echo "demo.sh: bakerd did not start within 10 s, see $demo_dir/bakerd.log" >&2; exit 1; }
export DRTV_SERVER=$address

say "Bake (preset $preset)"
rm -rf "$demo_dir/sectors"
"$bin/bake" submit "$demo_dir/map/island.gltf" --preset "$preset" --wait --pull "$demo_dir/sectors"

say "Validate"
"$bin/drtv" validate --neighbours "$demo_dir/sectors"

say "Picture"
"$bin/drtv" preview "$demo_dir/sectors" --out "$demo_dir/island.png"
"$bin/drtv" preview "$demo_dir/sectors" --quantity sky --out "$demo_dir/island_sky.png"

count=$(find "$demo_dir/sectors" -name '*.drtv' | wc -l)
cat <<END

$count sector files: $demo_dir/sectors
pictures:         $demo_dir/island.png  $demo_dir/island_sky.png
END
