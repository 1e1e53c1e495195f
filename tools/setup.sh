#!/bin/bash
# Installs what Tenebra needs and this machine lacks (Debian 12, Ubuntu 24.04 or later).
# Usage: tools/setup.sh [--tests]    --tests: also what the tests need
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config git python3 python3-glad
  libegl-dev libopengl-dev libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6
  libglm-dev libfmt-dev libexpected-dev libtinygltf-dev libtinyobjloader-dev
  nlohmann-json3-dev libcli11-dev libstb-dev libtbb-dev libhwy-dev
  libzstd-dev libxxhash-dev
  libglfw3-dev libimgui-dev libgl1 libglx-mesa0 fonts-dejavu-core
)
if [[ "${1:-}" == --tests ]]; then
  packages+=(libgtest-dev libgmock-dev libbenchmark-dev libembree-dev libgmp-dev
    xvfb xauth xdotool imagemagick x11-xserver-utils)
fi

if ! command -v dpkg-query apt-get > /dev/null; then
  echo "tools/setup.sh: no apt-get here; install what corresponds to: ${packages[*]}" >&2
  exit 1
fi
missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null)" == installed ]] || missing+=("$package")
done
if ((${#missing[@]})); then
  echo "Installing ${missing[*]}"
  as_root=(env DEBIAN_FRONTEND=noninteractive)
  ((EUID == 0)) || as_root=(sudo "${as_root[@]}")
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" > /dev/null
fi
