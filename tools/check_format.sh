#!/bin/bash
# Fails, with a sentence that names the files, if clang-format would change any C++ file of the project.
# Usage: tools/check_format.sh [--fix]    --fix: reformats them
# The version matters: others break lines differently. CLANG_FORMAT names the program, if not clang-format-14.
set -euo pipefail
cd "$(dirname "$0")/.."
wanted=14

stop() {
  echo "tools/check_format.sh: $*" >&2
  exit 2
}

format=${CLANG_FORMAT:-$(command -v "clang-format-$wanted" || command -v clang-format || true)}
[[ -n $format ]] || stop "clang-format is missing: install the package clang-format-$wanted"
version=$("$format" --version | sed -n 's/.*version \([0-9]*\).*/\1/p')
[[ $version == "$wanted" ]] || stop "found clang-format $version, expected version $wanted (CLANG_FORMAT names another)"

mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.cpp' '*.h' | while read -r file; do
  [[ ! -e $file ]] || echo "$file"
done)
if [[ ${1:-} == --fix ]]; then
  "$format" -i "${files[@]}"
  exit 0
fi
# One process for all files is quick; the files that it complains about are named before the first colon.
mapfile -t changed < <("$format" --dry-run "${files[@]}" 2>&1 | sed -n 's/^\([^:]*\):[0-9].*clang-formatted.*/\1/p' | sort -u)
if ((${#changed[@]})); then
  echo "clang-format would change ${#changed[@]} of ${#files[@]} files (tools/check_format.sh --fix does it):" "${changed[@]}" >&2
  exit 1
fi
echo "All ${#files[@]} files are formatted."
