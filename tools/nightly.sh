#!/bin/bash
# The checks that do not fit into .ci/run. Each part has a name, says what it does, and ends with ok or failed.
# Usage: tools/nightly.sh PART...
#   lto-odr   links the programs with link-time optimisation: two definitions of one name are an error
#   clang     builds everything with clang++, warnings are errors, and runs all tests
#   tidy      runs clang-tidy on every file except the tests (.clang-tidy has the checks)
#   roots     builds and tests on other systems (ROOTS="debian13 ubuntu24.04"); needs root and mmdebstrap or debootstrap
#   debug     runs the libraries' unit tests as the debug preset builds them
#   asan      runs all tests with the address and undefined-behaviour sanitizers
#   tsan      runs all tests with the thread sanitizer
#   report    opens a page of `tenebra log report` in headless Chromium
#   three     opens baked files in three.js in headless Chromium; takes npm's package three
#   package   makes the packages, asks lintian, and draws a picture with them in a bare root; needs root as roots does
#   api       makes the reference of the public headers with doxygen: what is not documented is an error
#   site      makes the documentation site in build/site and checks its links: a warning is an error
#   pairs     draws small frames by options in random combinations for PAIRS_MINUTES [60], with the address and
#             undefined-behaviour sanitizers
#   faults    lets every call of the system and many allocations fail, kills renders, stops each stage
#   slurm     renders on three Slurm nodes, one of which dies while another is cut off; needs root and Slurm
#   viewer    gives the window random input for VIEWER_FRAMES [500] frames, with the address and undefined-behaviour sanitizers
#   arm64     cross-builds for 64-bit ARM in a root of its own, runs the numerics' tests under qemu and compares the hashes
#             with those of x86; needs root as roots does
#   same-bytes  builds the program in two folders: the same bytes, and no name of a folder in them
#   figures   measures the README's key figures again (FIGURES_DATA names the folder of BART's scenes)
#   fuzz      runs the fuzzers of tests/fuzz for FUZZ_MINUTES [60]
#   all       every part, one after the other
# Exit code: 0 if every part that was asked for is ok, 1 if one failed, 2 if the request was not understood.
# JOBS=N: how many jobs at once [all cores].
set -uo pipefail
cd "$(dirname "$0")/.."
parts=(lto-odr clang tidy roots debug asan tsan report three package api site pairs faults slurm viewer arm64 same-bytes figures fuzz)
jobs=${JOBS:-$(nproc)}

has() {
  command -v "$1" > /dev/null || { echo "$1 is missing: install the package $2" >&2; return 1; }
}

# Static libraries of objects that only the linker's plugin can read need gcc's own ar and ranlib. Link-time
# optimisation sees all files of a program at once, and so also what no single compilation can: that two of them
# mean different things by one name. Types are compared, not speed: little optimisation and two vector levels will
# do, and files that are compiled together cannot mean different things.
run_lto-odr() {
  has gcc-ar gcc && tools/setup.sh --tests &&
    cmake -S . -B build-lto -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENEBRA_TESTS=ON \
      -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" -DTENEBRA_LEVELS=native -DTENEBRA_UNITY=ON \
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

# One folder at a time (as one file that includes its files), and one vector level: the headers of a file take longer
# to read than the file itself.
run_tidy() {
  has clang-tidy clang-tidy && tools/setup.sh &&
    cmake -S . -B build-tidy -G Ninja -DTENEBRA_TESTS=OFF -DTENEBRA_UNITY=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON > /dev/null &&
    cmake --build build-tidy --target tenebra_glad_generate > /dev/null &&
    python3 -c 'import json
for unit in json.load(open("build-tidy/compile_commands.json")): print(unit["file"])' |
    xargs -P "$jobs" -n 1 clang-tidy --quiet -p build-tidy --checks=-bugprone-suspicious-include \
      --extra-arg=-DHWY_COMPILE_ONLY_STATIC
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

# The page's script has run if a frame is chosen; anything missing from the page would show as a request to the network.
run_report() {
  local browser folder page
  browser=$(command -v chromium-headless-shell || command -v chromium) ||
    { echo "Chromium is missing: install the package chromium-headless-shell" >&2; return 1; }
  folder=$(mktemp -d) || return 1
  cmake --preset release > /dev/null && cmake --build --preset release -j "$jobs" --target tenebra || return 1
  for shadows in none hard; do
    build/bin/tenebra render scenes/city.glb --frames 0:4 --size 160x90 --shadows "$shadows" --quiet \
      -o "$folder/$shadows%04d.png" --log "$folder/$shadows.csv" || return 1
  done
  build/bin/tenebra log report "$folder"/{none,hard}.csv --pictures "$folder/none%04d.png" \
    --pictures-b "$folder/hard%04d.png" -o "$folder/report.html" || return 1
  ! grep -E "https?://|src=\"[^d]" "$folder/report.html" || { echo "the page asks a network" >&2; return 1; }
  page=$("$browser" --headless --no-sandbox --dump-dom "file://$folder/report.html" 2> /dev/null)
  rm -r "$folder"
  grep -q 'class="which">frame 2<' <<< "$page" && grep -q 'aria-pressed="true"' <<< "$page"
}

# Compares the picture that three.js draws of a baked room with the rendered one.
run_three() {
  local browser
  browser=$(command -v chromium-headless-shell || command -v chromium) ||
    { echo "Chromium is missing: install the package chromium-headless-shell" >&2; return 1; }
  has npm npm && cmake --preset release > /dev/null && cmake --build --preset release -j "$jobs" --target tenebra &&
    npm install --silent --no-save --prefix build/three three@0.170 > /dev/null &&
    python3 tests/three_test.py build/bin/tenebra scenes/room.glb build/three/node_modules/three "$browser"
}

# The root has no compiler and no checkout: the packages must be enough.
run_package() {
  local root status
  root=$(mktemp -d) || return 1
  tools/package.sh --check && tools/make_root.sh --root "$root" --only-make debian12 &&
    cp build-package/tenebra_*.deb "$root/opt" &&
    tools/make_root.sh --root "$root" --run 'cd /opt && apt-get update -qq &&
      time (apt-get install -y -qq --no-install-recommends ./tenebra_*.deb > /dev/null && ! command -v g++ &&
        tenebra render /usr/share/tenebra/scenes/city.glb -o city.png && tenebra info /usr/share/tenebra/scenes/court.glb)' \
      debian12
  status=$?
  rm -rf "$root"
  return "$status"
}

run_arm64() {
  tools/make_root.sh --root "${TMPDIR:-/tmp}/tenebra-roots/debian12-arm64" --run "JOBS=$jobs tools/arm64.sh" debian12
}

run_api() {
  has doxygen doxygen && mkdir -p build/api && TENEBRA_API_DIR=build/api doxygen docs/Doxyfile
}

# AnchorCheck: headings too. Links to other hosts are not checked.
run_site() {
  has mkdocs mkdocs && has linkchecker linkchecker && tools/site.py build/site &&
    echo '[AnchorCheck]' > build/site/linkchecker.ini &&
    linkchecker -f build/site/linkchecker.ini --no-status --ignore-url='^https?://' build/site/site/index.html
}

run_faults() {
  local tests=tests/faults/faults_test.py program=build/bin/tenebra library=build/tests/libtenebra_failing_calls.so
  cmake --preset release -DTENEBRA_TESTS=ON && cmake --build build --target tenebra tenebra_failing_calls -j "$jobs" || return 1
  python3 "$tests" calls "$program" "$library" && python3 "$tests" memory "$program" "$library" 20 &&
    tests/resume_test.py "$program" scenes/city.glb 200 && python3 tests/stop_test.py "$program" scenes all
}

run_slurm() {
  local part
  for part in slurmctld slurmd munged:munge sbatch:slurm-client ip:iproute2; do has "${part%:*}" "${part#*:}" || return 1; done
  cmake --preset release > /dev/null && cmake --build --preset release -j "$jobs" --target tenebra &&
    python3 tests/slurm_test.py build/bin/tenebra "${SLURM_SCENE:-scenes/city.glb}" --frames "${SLURM_FRAMES:-300}" --chunks 10
}

# The scene for random input is small, because sanitizers are slow.
run_viewer() {
  has Xvfb xvfb && has xdotool xdotool && tools/setup.sh --tests && cmake --preset asan > /dev/null &&
    cmake --build --preset asan -j "$jobs" --target tenebra &&
    LSAN_OPTIONS="suppressions=$PWD/cmake/sanitizers/lsan.supp:print_suppressions=0" \
      python3 tests/random_hands.py build-asan/bin/tenebra scenes/city.glb "${VIEWER_FRAMES:-500}" "${VIEWER_SEED:-1}" -- --size 160x120
}

run_pairs() {
  tools/setup.sh --tests && cmake --preset asan > /dev/null &&
    cmake --build --preset asan -j "$jobs" --target tests_render &&
    TENEBRA_RANDOM_SECONDS=$((60 * ${PAIRS_MINUTES:-60})) MESA_SHADER_CACHE_DISABLE=1 \
      LSAN_OPTIONS="suppressions=$PWD/cmake/sanitizers/lsan.supp:print_suppressions=0" \
      build-asan/bin/tests_render --gtest_filter=OptionPairs.DrawTheSameInRandomCombinations
}

# Without ccache, which would take the second folder's objects from the first. As packages are built: folders as one file.
run_same-bytes() {
  local folders one two folder program status=0
  folders=$(mktemp -d) && one=$folders/one two=$folders/two/below || return 1
  for folder in "$one" "$two"; do
    mkdir -p "$folder" && git archive HEAD | tar x -C "$folder" &&
      cmake -S "$folder" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTENEBRA_TESTS=OFF \
        -DTENEBRA_UNITY=ON > /dev/null &&
      CCACHE_DISABLE=1 cmake --build "$folder/build" -j "$jobs" --target tenebra tenebra_c_api || status=1
  done
  for program in bin/tenebra libtenebra.so; do
    cmp "$one/build/$program" "$two/build/$program" || status=1
    ! grep -aqF "$folders" "$one/build/$program" || { echo "$program names the folder of its build" >&2; status=1; }
  done
  rm -r "$folders"
  return "$status"
}

run_figures() {
  cmake --preset release -DTENEBRA_TESTS=ON > /dev/null &&
    cmake --build --preset release -j "$jobs" --target tenebra tenebra-bench &&
    tools/check_figures.py ${FIGURES_DATA:+--data "$FIGURES_DATA"}
}

run_fuzz() { tools/fuzz.sh "${FUZZ_MINUTES:-60}"; }

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
