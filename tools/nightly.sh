#!/bin/bash
# The checks that do not fit into .ci/run. Each part has a name, says what it does, and ends with ok or failed.
# Usage: tools/nightly.sh PART...
#   lto-odr   links the programs with link-time optimisation: two definitions of one name are an error
#   clang     builds everything with clang++, warnings are errors, and runs all tests
#   roots     builds and tests on other systems (ROOTS="debian13 ubuntu24.04"); needs root and mmdebstrap or debootstrap
#   debug     runs the libraries' unit tests as the debug preset builds them
#   asan      runs all tests with the address and undefined-behaviour sanitizers
#   tsan      runs all tests with the thread sanitizer
#   all       every part, one after the other
# Exit code: 0 if every part that was asked for is ok, 1 if one failed, 2 if the request was not understood.
# JOBS=N: how many jobs at once [all cores].
set -uo pipefail
cd "$(dirname "$0")/.."
parts=(lto-odr clang roots debug asan tsan)
jobs=${JOBS:-$(nproc)}

has() {
  command -v "$1" > /dev/null || { echo "$1 is missing: install the package $2" >&2; return 1; }
}

# Static libraries of objects that only the linker's plugin can read need gcc's own ar and ranlib. Link-time
# optimisation sees all files of a program at once, and so also what no single compilation can: that two of them
# mean different things by one name.
run_lto-odr() {
  has gcc-ar gcc && tools/setup.sh --tests &&
    cmake -S . -B build-lto -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENEBRA_TESTS=ON \
      -DCMAKE_AR="$(command -v gcc-ar)" -DCMAKE_RANLIB="$(command -v gcc-ranlib)" \
      -DCMAKE_CXX_FLAGS="-flto=auto -Wodr -Werror=odr -Wlto-type-mismatch -Werror=lto-type-mismatch" > /dev/null &&
    cmake --build build-lto -j "$jobs" --target tenebra tenebra-bench &&
    build-lto/bin/tenebra --version
}

run_clang() {
  has clang++ clang && tools/setup.sh --tests &&
    cmake -S . -B build-clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENEBRA_TESTS=ON \
      -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS=-Werror > /dev/null &&
    cmake --build build-clang -j "$jobs" &&
    ctest --test-dir build-clang --output-on-failure -j "$jobs"
}

run_roots() {
  local root failed=0
  for root in ${ROOTS:-debian13 ubuntu24.04}; do
    echo "--- $root"
    tools/make_root.sh "$root" || { echo "$root failed"; failed=1; }
  done
  return "$failed"
}

# Tests of a preset of CMakePresets.json.
run_preset() {
  tools/setup.sh --tests && cmake --preset "$1" > /dev/null && cmake --build --preset "$1" -j "$jobs" &&
    ctest --preset "$1" -j "$jobs"
}

run_debug() { tools/setup.sh --tests && tools/test_debug.sh; }
run_asan() { run_preset asan; }
run_tsan() { run_preset tsan; }

usage() {
  sed -n '2,/^# JOBS/s/^# \{0,1\}//p' "$0"
}

asked=()
for part in "$@"; do
  if [[ $part == all ]]; then
    asked+=("${parts[@]}")
  elif [[ " ${parts[*]} " == *" $part "* ]]; then
    asked+=("$part")
  elif [[ $part == -h || $part == --help ]]; then
    usage
    exit 0
  else
    echo "tools/nightly.sh: found the part '$part', expected ${parts[*]} or all" >&2
    exit 2
  fi
done
if ((${#asked[@]} == 0)); then
  usage >&2
  exit 2
fi

results=() code=0
for part in "${asked[@]}"; do
  echo "=== $part: $(sed -n "s/^#   $part  *//p" "$0")"
  start=$SECONDS
  if "run_$part"; then result=ok; else result=failed code=1; fi
  results+=("$part: $result ($(((SECONDS - start) / 60)) min)")
  echo "=== ${results[-1]}"
done
((${#results[@]} == 1)) || printf '%s\n' "" "${results[@]}"
exit "$code"
