#!/bin/bash
# Installs what Tenebra needs and this machine lacks (Debian 12 and 13, Ubuntu 24.04).
# Usage: tools/setup.sh [--window | --tests | --package]
#   without an option   what is needed to build, and to draw without a display: all that ./demo.sh needs
#   --window            also the font of `tenebra view`
#   --tests             also what the tests need; with it, Embree for --ao rays, compressed glTF files, FBX and others
#   --package           also what is needed to make packages
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config python3 python3-glad
  libegl-dev libopengl-dev libegl1 libegl-mesa0 libgl1-mesa-dri
  libglm-dev libfmt-dev libexpected-dev libtinygltf-dev
  nlohmann-json3-dev libcli11-dev libstb-dev libtbb-dev libhwy-dev
  libzstd-dev libdeflate-dev libxxhash-dev libgmp-dev libopenexr-dev
  libglfw3-dev libimgui-dev
)
where_known=()  # taken where this release has them
[[ "${1:-}" == --window || "${1:-}" == --tests ]] && packages+=(libgl1 libglx-mesa0 fonts-dejavu-core)
if [[ "${1:-}" == --tests ]]; then
  packages+=(libgtest-dev libembree-dev
    libmeshoptimizer-dev libdraco-dev libassimp-dev
    python3-dev python3-numpy python3-pybind11 python3-pytest python3-matplotlib
    xvfb xauth xdotool imagemagick x11-xserver-utils)
  # Mesa 25.1 and later have no OSMesa: EGL is enough. libwebp: pictures in WebP.
  # scikit-build: `pip install .`.
  where_known+=(libosmesa6 clang-format-14 libwebp-dev python3-skbuild)
fi
[[ "${1:-}" == --package ]] && packages+=(libembree-dev libmeshoptimizer-dev libdraco-dev libassimp-dev dpkg-dev help2man
  lintian
  python3-dev python3-pybind11)

if ! command -v dpkg-query apt-get > /dev/null; then
  echo "tools/setup.sh: no apt-get here; install what corresponds to: ${packages[*]}" >&2
  exit 1
fi
installed() {
  [[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2> /dev/null)" == installed ]]
}
as_root() {
  if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

# Another program, such as unattended upgrades, may hold apt's locks for minutes: waits for up to ten.
update_lists() {
  local said tries
  for ((tries = 0; tries < 60; ++tries)); do
    said=$(as_root env LC_ALL=C apt-get update -qq 2>&1) && return
    [[ $said == *"Could not get lock"* || $said == *"Unable to lock"* ]] || break
    ((tries > 0)) || echo "Waiting for another program that uses apt" >&2
    sleep 10
  done
  echo "$said" >&2
  return 1
}

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
((${#missing[@]} == 0)) || update_lists
for package in "${where_known[@]}"; do
  if ! installed "$package" && apt-cache show "$package" &> /dev/null; then missing+=("$package"); fi
done
if ((${#missing[@]})); then
  echo "Installing ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends "${missing[@]}" > /dev/null
fi
