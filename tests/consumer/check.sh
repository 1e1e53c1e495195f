#!/bin/bash
# Does what a user of the library does, with the text of docs/library.md alone: installs the library to
# a folder of its own, copies the programs out of this page, builds them with CMake and with pkg-config, and runs
# them. Each program fails if its answer is not the known one. Nothing but the public headers may be reachable.
# usage: check.sh BUILD_FOLDER
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
programs=(hard soft occlusion points)

stop() {
  echo "consumer: $*" >&2
  exit 1
}

# Runs a command; what it prints is shown only if it fails.
quietly() {
  local log=$work/log
  "$@" > "$log" 2>&1 || { cat "$log" >&2; stop "failed: $*"; }
}

# Blocks of code whose first line is a comment with a file's name: // hard.cpp or # CMakeLists.txt
extract_programs() {
  mkdir "$work/source"
  awk -v folder="$work/source/" '
    /^```/ { file = ""; first = ($0 ~ /^```(cpp|cmake)$/); next }
    first { first = 0; if ($2 ~ /\.(cpp|txt):?$/) { file = folder $2; sub(/:$/, "", file) } }
    file != "" { print > file }' "$root/docs/library.md"
  local name
  for name in CMakeLists.txt "${programs[@]/%/.cpp}"; do
    [[ -s $work/source/$name ]] || stop "docs/library.md: found no block of code that begins with the name $name"
  done
}

check_installed_headers() {
  local others
  others=$(cd "$prefix/include" && find . -type f ! -path './tenebra/*.h')
  [[ -z $others ]] || stop "installed besides the public headers:"$'\n'"$others"
  diff <(ls "$root/include/tenebra") <(ls "$prefix/include/tenebra") || stop "the public headers are not all installed"
}

# Whether a program that includes $1 compiles with the flags that pkg-config gives.
compiles() {
  echo "#include $1" | "$compiler" -std=c++20 -fsyntax-only "${flags[@]}" -x c++ - > "$work/log" 2>&1
}

check_reachable() {
  local header
  for header in "$prefix"/include/tenebra/*.h; do
    compiles "<tenebra/$(basename "$header")>" || { cat "$work/log" >&2; stop "$header does not compile by itself"; }
  done
  for header in soft/solve/group_solver.h shadow/decision/decide.h io/image.h simd/pack-inl.h; do
    [[ -e $root/src/$header ]] || stop "src/$header is gone: name another internal header here"
    for include in "<$header>" "\"$header\"" "<tenebra/$header>"; do
      ! compiles "$include" || stop "the internal header $include can be included"
    done
  done
}

compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
extract_programs
quietly cmake --install "$build" --prefix "$prefix"
check_installed_headers

quietly cmake -S "$work/source" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix"
quietly cmake --build "$work/build"
for program in "${programs[@]}"; do
  "$work/build/$program" || stop "$program (CMake) did not give the known answer"
done
mkdir "$work/newer"
cat > "$work/newer/CMakeLists.txt" << 'END'
cmake_minimum_required(VERSION 3.25)
project(newer LANGUAGES CXX)
find_package(tenebra 99 QUIET)
if(tenebra_FOUND)
  message(FATAL_ERROR "find_package(tenebra 99) found version ${tenebra_VERSION}")
endif()
END
quietly cmake -S "$work/newer" -B "$work/newer/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix"

pc=$(find "$prefix" -name tenebra.pc)
[[ -n $pc ]] || stop "tenebra.pc is not installed"
export PKG_CONFIG_PATH=${pc%/*}${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
# shellcheck disable=SC2207  # flags are words
flags=($(pkg-config --cflags tenebra)) libraries=($(pkg-config --libs tenebra))
for program in "${programs[@]}"; do
  quietly "$compiler" -std=c++20 "$work/source/$program.cpp" "${flags[@]}" "${libraries[@]}" -o "$work/$program"
  "$work/$program" || stop "$program (pkg-config) did not give the known answer"
done
check_reachable

if pkg-config --exists glfw3; then  # the program that draws for itself; tests_host runs it
  mkdir "$work/foreign"
  cat > "$work/foreign/CMakeLists.txt" << END
cmake_minimum_required(VERSION 3.25)
project(foreign LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 20)
find_package(tenebra REQUIRED)
find_package(glfw3 REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL)
add_executable(foreign $root/tests/consumer/foreign_renderer.cpp)
target_link_libraries(foreign PRIVATE tenebra::host tenebra::query glfw OpenGL::OpenGL)
END
  quietly cmake -S "$work/foreign" -B "$work/foreign/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$prefix"
  quietly cmake --build "$work/foreign/build"
fi

quietly cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$root/tests/consumer/mask.c" -I"$prefix/include" \
  -L"$prefix/lib" -ltenebra -lm -Wl,-rpath,"$prefix/lib" -o "$work/mask"
"$work/mask" || stop "mask.c (C) did not give the known answers"
mkdir "$work/c"
cat > "$work/c/CMakeLists.txt" << END
cmake_minimum_required(VERSION 3.25)
project(mask LANGUAGES C CXX)
find_package(tenebra REQUIRED)
add_executable(mask $root/tests/consumer/mask.c)
target_link_libraries(mask tenebra::c m)
END
quietly cmake -S "$work/c" -B "$work/c/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix"
quietly cmake --build "$work/c/build"
"$work/c/build/mask" || stop "mask.c (C, CMake) did not give the known answers"
