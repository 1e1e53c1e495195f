#!/bin/bash
# Draws docs/modes.png (one room with hard shadows, soft ones, occlusion, both) and docs/scenes.png (the bundled scenes,
# BART, and free models). Needs ImageMagick.
# Usage: tools/draw_scenes.sh PROGRAM MODELS    MODELS: a folder with bart/, gltf/ and obj/ as the list below has them
set -euo pipefail
[[ $# == 2 ]] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
program=$(realpath "$1") models=$(realpath "$2")
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
count=0

draw_mode() {
  "$program" render scenes/room.glb --size 600x450 --antialias 8 "${@:2}" -o "$work/mode_$1.png" --quiet
}

draw_mode 1 --shadows hard
draw_mode 2 --shadows soft
draw_mode 3 --shadows hard --ao adaptive --ao-error 1
draw_mode 4 --shadows soft --ao adaptive --ao-error 1
montage "$work"/mode_*.png -tile 4x -resize 300x -geometry +2+2 -background white "$work/modes.png"
convert "$work/modes.png" -alpha off -depth 8 -define png:compression-level=9 -strip docs/modes.png

draw() {
  count=$((count + 1))
  "$program" render "$@" --size 800x533 -o "$work/$(printf %02d "$count").png" --quiet
}

draw scenes/city.glb --time 2
draw scenes/court.glb
draw scenes/gallery.glb
draw scenes/square.glb --time 1
draw "$models/bart/kitchen/kitchen.aff"
draw "$models/bart/museum/museum5.aff" --time 1.2
draw "$models/bart/robots/Robot.aff"
draw "$models/gltf/Fox.glb" --fov 30
draw "$models/gltf/FlightHelmet/FlightHelmet.gltf" --fov 40
draw "$models/gltf/Lantern/Lantern.gltf" --fov 40
draw "$models/gltf/JapaneseBridgeGarden.glb" --fov 26
draw "$models/obj/spot.obj" --fov 36
montage "$work"/[0-9]*.png -tile 4x -resize 400x -geometry +3+3 -background white "$work/sheet.png"
convert "$work/sheet.png" -alpha off -dither FloydSteinberg -colors 256 -define png:compression-level=9 -strip PNG8:docs/scenes.png
