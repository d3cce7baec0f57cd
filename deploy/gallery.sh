#!/usr/bin/env bash
# Makes docs/gallery.md and its pictures again, from what deploy/demo.sh has built and baked. 15 minutes on two cores.
#   deploy/gallery.sh [FOLDER]     FOLDER: the demo's, default ./demo
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
demo_dir=$(cd "${1:-$source_dir/demo}" && pwd)
bin=$source_dir/build/release/bin
pictures=$source_dir/docs/gallery
page=$source_dir/docs/gallery.md
map=$demo_dir/map/island.gltf
fence=$(printf '\x60\x60\x60')
# shellcheck source=deploy/daemon.sh
. "$source_dir/deploy/daemon.sh"

say "Bake, with local radiance transfer"
start_daemon "$bin" "$demo_dir"
"$bin/bake" submit "$map" --preset console --set lprt=1 --pull "$demo_dir/gallery_sectors"

mkdir -p "$pictures"
cat >"$page" <<'END'
# Gallery

Each part of the light on the demo's island: relit by the runtime as a game would (left), by path tracing (middle), and relit
with true colours at the probes (right), so that errors of the files can be told from errors of relighting. Parts are shown on
white surfaces, each at an exposure of its own. `deploy/gallery.sh` makes this page again.

The tables give percent of the mean light: how much too bright or dark it is, and the root mean square of errors over all pixels.
They belong to these pictures, many of which show hard cases on purpose: [measurements](measurements.md) has whole maps.
END

# shown NAME TITLE TEXT ARGUMENTS...
shown() {
  local name=$1 title=$2 text=$3 table
  shift 3
  say "$title"
  table=$("$bin/bakerd" render "$demo_dir/gallery_sectors" --map "$map" --gradients "$source_dir/deploy/demo_map/day.json" \
    --size 400x225 --compare --out "$pictures/$name.png" "$@")
  {
    printf '\n## %s\n\n![%s](gallery/%s.png)\n\n%s\n\n' "$title" "$title" "$name" "$text"
    printf '%s\nbakerd render … %s\n%s\n%s\n' "$fence" "$*" "$(grep -v "$pictures" <<<"$table")" "$fence"
  } >>"$page"
}

village=(--camera "233,-72,54.3" --look "215,-80,53.5")
jungle=(--camera "126,-152,34" --look "100,-150,34")
dark=(--group "lanterns=0,0,0" --group "huts=0,0,0")

shown sky_direct "Sky direct" "The jungle's floor sees little of the sky. Probes stand 6 m apart and know nothing of a single trunk." \
  --show sky_direct --time 10:00 --paths 96 "${jungle[@]}"
shown sky_bounce "Sky bounce" "Light of the sky that grass and walls bounce. Flat ground gets hardly any; four colours per probe cannot leave it out
altogether, because their upward directions see the ground too." --show sky_bounce --time 10:00 --paths 256 "${village[@]}"
shown sun_bounce "Sun bounce" "Grass in the sun shines green on the walls. Two bands of transfer cannot cast the sun's shadows." \
  --show sun_bounce --time 09:00 --paths 256 "${village[@]}"
shown static "Static light" "Lanterns at night, a light group of the map." --show static --time 20:00 --paths 256 "${village[@]}"
shown local "Local transfer" "The bounce of a lamp that the game has placed beside a hut. Where light comes from straight below, as under a lamp over
open ground, two bands give a negative value for surfaces that face up, which takes away from other light." \
  --show local --time 20:00 --paths 256 "${dark[@]}" --light 214,-82,53.2,14,8,4 "${village[@]}"
shown interior "Interior" "A hut that is lit by one probe, through its door and windows. Each wall has one colour." \
  --show ambient --time 12:00 --paths 256 --camera 243.3,-73.6,54 --look 240,-76.5,53.5 --fov 80
shown distance "Distance" "From above, where all but the nearest trees lie outside of the volume. There the ambient light is that of an open sky, darkened
by how little of it each column of ground sees." --time 15:00 --paths 64 --camera 40,60,92 --look 230,150,10
shown all "All together" "The village at nine." --time 09:00 --paths 128 "${village[@]}"
