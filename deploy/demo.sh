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
# shellcheck source=deploy/daemon.sh
. "$source_dir/deploy/daemon.sh"

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
start_daemon "$bin" "$demo_dir"

say "Bake (preset $preset)"
rm -rf "$demo_dir/sectors"
"$bin/bake" submit "$demo_dir/map/island.gltf" --preset "$preset" --wait --pull "$demo_dir/sectors"

say "Validate"
"$bin/drtv" validate --neighbours "$demo_dir/sectors"

say "Pictures"
map=$demo_dir/map/island.gltf
render() { "$bin/bakerd" render "$demo_dir/sectors" --map "$map" "$@"; }
# Two huts, lanterns and the jungle of the inland village, at four times of a day that an artist has set.
render --camera 233,-72,54.3 --look 215,-80,53.5 --gradients "$source_dir/deploy/demo_map/day.json" \
  --times 06:45,12:00,17:15,20:00 --out "$demo_dir/island_day.png"
render --top --size 1600x1143 --out "$demo_dir/island_above.png"
"$bin/drtv" preview "$demo_dir/sectors" --under "$demo_dir/island_above.png" --out "$demo_dir/island_probes.png"
"$bin/drtv" preview "$demo_dir/sectors" --quantity sky --out "$demo_dir/island_sky.png"

count=$(find "$demo_dir/sectors" -name '*.drtv' | wc -l)
cat <<END

$count sector files: $demo_dir/sectors
pictures:         $demo_dir/island_day.png  the island over a day
                  $demo_dir/island_above.png  island_probes.png  island_sky.png
END
