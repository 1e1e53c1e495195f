#!/bin/bash
# Builds Tenebra and renders part of a bundled animation to out/. Arguments are passed on to `tenebra render`:
#   ./demo.sh --frames all --size 1920x1080
set -euo pipefail
cd "$(dirname "$0")"

tools/setup.sh
# A first build compiles each folder's files together and for the vector instructions of this machine, which takes less
# time; an existing build folder keeps its settings.
[[ -e build/CMakeCache.txt ]] && first=() || first=(-DTENEBRA_UNITY=ON -DTENEBRA_LEVELS=native)
cmake --preset release -DTENEBRA_TESTS=OFF "${first[@]}" > /dev/null
cmake --build --preset release --target tenebra

build/bin/tenebra render scenes/city.glb --frames 0:95:4 --size 960x540 -o out/%04d.png --mask out/mask_%04d.png \
  --log out/frames.csv --log trace:out/trace.json "$@"

echo
echo "Look at:  $PWD/out/0000.png and the pictures after it, mask_*.png: the shadow masks"
echo "          $PWD/out/frames.csv     how long each frame took"
echo "          $PWD/out/trace.json     the same for https://ui.perfetto.dev"
echo "Next:     build/bin/tenebra --help"
