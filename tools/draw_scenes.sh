#!/bin/bash
# Draws docs/scenes.png: the bundled scenes, BART, and free models. Needs ImageMagick.
# Usage: tools/draw_scenes.sh PROGRAM MODELS    MODELS: a folder with bart/, gltf/ and obj/ as the list below has them
set -euo pipefail
[[ $# == 2 ]] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
program=$(realpath "$1") models=$(realpath "$2")
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
count=0

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
