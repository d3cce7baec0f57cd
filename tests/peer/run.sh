#!/bin/sh
# Compares drtv with Blender's Cycles on three maps: tests/peer/run.sh BIN DATA (see README.md). Exits 1 when one disagrees.
set -eu
[ $# -eq 2 ] || { echo "usage: $0 BIN DATA" >&2; exit 2; }
peer="python3 $(dirname "$0")/peer.py --bin $1"
status=0
$peer "$2/maps/tutuila_512m.glb" --region 65,129,66,130 || status=1
$peer "$2/maps/volcano_island.glb" --region 129,129,130,130 || status=1
$peer "$2/C_sponza/sponza.gltf" --region=-18,-11,17,10 --lattice=-11,-2.5,1.5,10,2.1,9.5,8,3,3 || status=1
exit $status
