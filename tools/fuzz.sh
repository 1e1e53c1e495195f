#!/bin/bash
# Looks for input that breaks code that reads files: scenes (AFF, glTF, GLB, OBJ, PLY, STL; those that can be read are written as
# GLB and read again), pictures, option files, edits, --ao-cache; and for triangles for which the methods of hard and
# soft shadows and ambient occlusion disagree with each other or with the oracles. Builds the fuzzers of tests/fuzz with
# clang's libFuzzer, address sanitizer and the quick checks of undefined behaviour, in build-fuzz, and runs them one
# after the other for MINUTES in all.
# Usage: tools/fuzz.sh MINUTES [FUZZER...]    FUZZER: aff gltf glb obj ply stl picture exr config edits cache hard soft ao [all]
# They start from tests/fuzz/corpus and from what earlier runs found, in build-fuzz/corpus. Input that breaks something
# is left in build-fuzz/found, and the fuzzer's output says what happened.
# Without clang, and in CI, the tests give the same fuzzers what is in the corpus and changed inputs (tests/fuzz/replay.cpp;
# ctest -R '^fuzz_' takes two minutes).
# Exit code: 0 nothing found, or no clang here; 1 something found; 2 the request was not understood.
set -uo pipefail
cd "$(dirname "$0")/.."
fuzzers=(aff gltf glb obj ply stl picture exr config edits cache hard soft ao)

if [[ ! ${1:-} =~ ^[0-9]+$ || $1 =~ ^0+$ ]]; then
  echo "tools/fuzz.sh: found '${1:-}', expected the minutes to run, like 10" >&2
  exit 2
fi
minutes=$((10#$1))
shift
((${#})) && [[ $1 != all ]] && fuzzers=("$@")
if ! command -v clang++ > /dev/null; then
  echo "tools/fuzz.sh: skipped, libFuzzer comes with clang and there is no clang++ here (package clang);"
  echo "the tests do without it what they can: ctest -R '^fuzz_'"
  exit 0
fi

# The checks of UBSan that are not here (null, alignment, object size) triple the time that clang takes for the kernels:
# over nine minutes for one solver, at four vector levels and -O2. `nightly.sh asan` has them.
checks=address,signed-integer-overflow,shift,bounds,float-cast-overflow,integer-divide-by-zero
cmake -S . -B build-fuzz -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_COMPILER=clang++ -DTENEBRA_TESTS=OFF \
  -DTENEBRA_PROGRAM=OFF -DTENEBRA_FUZZ=ON -DTENEBRA_SANITIZE="$checks,fuzzer-no-link" \
  -DTENEBRA_LEVELS=native -DTENEBRA_UNITY=ON -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" > /dev/null &&
  cmake --build build-fuzz --target "${fuzzers[@]/#/fuzz_}" -j "${JOBS:-$(nproc)}" || exit 1

mkdir -p build-fuzz/found
found=0
for fuzzer in "${fuzzers[@]}"; do
  mkdir -p "build-fuzz/corpus/$fuzzer"
  echo "--- $fuzzer"
  "build-fuzz/bin/fuzz_$fuzzer" "build-fuzz/corpus/$fuzzer" "tests/fuzz/corpus/$fuzzer" \
    -max_total_time="$((minutes * 60 / ${#fuzzers[@]} + 1))" -timeout=20 -rss_limit_mb=2560 -max_len=65536 \
    -artifact_prefix="build-fuzz/found/$fuzzer-" -print_final_stats=1 > "build-fuzz/$fuzzer.log" 2>&1 || {
    found=1
    grep -E "ERROR|SUMMARY|Test unit|written, but" "build-fuzz/$fuzzer.log"
    echo "    see build-fuzz/$fuzzer.log"
  }
  grep -E "number_of_executed_units|peak_rss" "build-fuzz/$fuzzer.log"
done
exit "$found"
