#!/usr/bin/env bash
# The same picture on this CPU and on QEMU's: same_picture.sh BAKERD WRITE_YARD. Exit 77 where there is no QEMU.
set -euo pipefail

bakerd=$1
write_yard=$2
command -v qemu-x86_64 >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$write_yard" "$work"
render() {
  "$@" render "$work/sectors" --map "$work/yard.glb" --camera 26,2,3 --look 26,32,2 --size 96x54 \
    --times 07:00,12:00 --light 30,26,2.5,40,30,20 --out "$work/picture.png" >/dev/null
}
render "$bakerd"
mv "$work/picture.png" "$work/here.png"
render qemu-x86_64 -cpu max "$bakerd"
cmp "$work/here.png" "$work/picture.png"
