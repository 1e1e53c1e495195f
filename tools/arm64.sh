#!/bin/bash
# Builds the tests for 64-bit ARM with Debian's cross compiler, runs those of the numerics under qemu, and compares what
# Tenebra computes for frames of the bundled scenes with the hashes that x86 gave.
# Usage: tools/arm64.sh [SUITE...]
#   SUITE   folders of tests, and `hash`, in this order [math points shadow soft ao hash]
# Changes the system that it runs in: packages of two architectures. Meant for a root of Debian 12 of its own,
#   tools/make_root.sh --root FOLDER --run tools/arm64.sh debian12
# BUILD_TYPE=Quick [Release]: compiled by -O1, in a third of the time. JOBS=N [all cores].
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-arm64
suites=("$@")
((${#suites[@]})) || suites=(math points shadow soft ao hash)

native=(ca-certificates g++-aarch64-linux-gnu cmake ninja-build pkg-config python3 python3-glad qemu-user
  libglm-dev libexpected-dev nlohmann-json3-dev libcli11-dev)
foreign=(libegl-dev libopengl-dev libfmt-dev libtinygltf-dev libstb-dev libtbb-dev libhwy-dev
  libzstd-dev libdeflate-dev libxxhash-dev libgmp-dev libopenexr-dev libgtest-dev libembree-dev libstdc++6)

missing() {
  local package
  for package in "${native[@]}" "${foreign[@]/%/:arm64}"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null) == installed ]] || echo "$package"
  done
}

install_missing() {
  local packages
  mapfile -t packages < <(missing)
  ((${#packages[@]})) || return 0
  dpkg --add-architecture arm64
  apt-get update -qq
  # One after the other: apt finds no way to all of the second architecture at once.
  for package in "${packages[@]}"; do
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$package" > /dev/null
  done
}

# The file has more frames than --quick hashes: each of its lines has to be in the file as it is.
compare_hashes() {
  local of_arm=$build/hashes.txt differing
  qemu-aarch64 "$build/bin/tenebra-bench" hash --bundled --quick -o "$of_arm"
  differing=$(grep -v '^#' "$of_arm" | grep -vxF -f tests/reference/hashes.txt || true)
  [[ -z $differing ]] || { echo "other values than on x86:"; echo "$differing"; return 1; }
  grep -qv '^#' "$of_arm" || { echo "tenebra-bench hash wrote no hashes"; return 1; }
  echo "$(grep -vc '^#' "$of_arm") hashes, all as on x86"
}

install_missing
cmake -S . -B $build -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/arm64.cmake -DCMAKE_BUILD_TYPE="${BUILD_TYPE:-Release}" \
  -DCMAKE_CXX_FLAGS_QUICK="-O1 -DNDEBUG" -DTENEBRA_UNITY=ON -DTENEBRA_TESTS=ON -DTENEBRA_PROGRAM=OFF > /dev/null
for suite in "${suites[@]}"; do
  if [[ $suite == hash ]]; then
    cmake --build $build -j "${JOBS:-$(nproc)}" --target tenebra-bench
    compare_hashes
  else
    cmake --build $build -j "${JOBS:-$(nproc)}" --target "tests_$suite"
    ctest --test-dir $build --output-on-failure -j "${JOBS:-$(nproc)}" -L "^$suite\$"
  fi
done
