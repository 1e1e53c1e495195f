#!/bin/bash
# Builds everything and runs all tests. Arguments are passed on to ctest:
#   ./test.sh -R OutputFile
set -euo pipefail
cd "$(dirname "$0")"

tools/setup.sh --tests
# A first build compiles each folder's files together and for the vector instructions of this machine, which takes less
# time; an existing build folder keeps its settings.
[[ -e build/CMakeCache.txt ]] && first=() || first=(-DTENEBRA_UNITY=ON -DTENEBRA_LEVELS=native)
cmake --preset release -DTENEBRA_TESTS=ON "${first[@]}" ${CI:+-DCMAKE_COMPILE_WARNING_AS_ERROR=ON} > /dev/null
cmake --build --preset release

code=0
ctest --test-dir build --output-on-failure -j2 "$@" || code=$?

# A skipped test is not a passed test: say how many there are, and why.
log=build/Testing/Temporary/LastTest.log
echo "Skipped tests: $(grep -c '^\[  SKIPPED \] .*ms)$' "$log" || true)"
grep -A1 ': Skipped$' "$log" | grep -v -e ': Skipped$' -e '^--$' | sort | uniq -c || true
exit "$code"
