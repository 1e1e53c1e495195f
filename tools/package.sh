#!/bin/bash
# Makes Debian packages of this checkout in build-package: tenebra (the program), libtenebra1 (the shared library of the C
# interface), libtenebra-dev (the libraries) and python3-tenebra (the Python module).
# Usage: tools/package.sh [--check]
#   --check   also asks lintian; its errors fail
# DEBFULLNAME and DEBEMAIL name who makes them, as for Debian's own tools [the author of the last commit].
# The same checkout gives the same bytes, in whatever folder: all times in the packages are that of the last commit.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-package
version=$(sed -n 's/^project(tenebra VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
maintainer="${DEBFULLNAME:-$(git log -1 --format=%an)} <${DEBEMAIL:-$(git log -1 --format=%ae)}>"
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)} LC_ALL=C.UTF-8

tools/setup.sh --package
# Keeps paths of this machine out of the built files.
cmake --preset release -B "$build" -DTENEBRA_TESTS=OFF -DTENEBRA_PYTHON=ON -DTENEBRA_UNITY=ON \
  -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$PWD/$build=build -ffile-prefix-map=$PWD=." > /dev/null
cmake --build "$build"

# Texts that Debian asks for, of each package.
rm -rf "$build/package"
for component in program:tenebra runtime:libtenebra1 development:libtenebra-dev python3:python3-tenebra; do
  name=${component#*:}
  texts=$build/package/${component%%:*}/share/doc/$name
  mkdir -p "$texts"
  {
    sed '/@license@/d' packaging/copyright.in
    sed -e '1,4d' -e 's/^$/./' -e 's/^/ /' LICENSE
  } > "$texts/copyright"
  {
    echo "$name ($version-1) unstable; urgency=medium"
    printf '\n  * See the changes of the project in its CHANGELOG.md.\n\n'
    echo " -- $maintainer  $(date -uR -d "@$SOURCE_DATE_EPOCH")"
  } | gzip -9n > "$texts/changelog.Debian.gz"
  gzip -9nc CHANGELOG.md > "$texts/changelog.gz"
done

# Manual pages and completions, from the program's help.
share=$build/package/program/share
mkdir -p "$share/man/man1"
manual() {  # manual COMMAND...: of `tenebra COMMAND...`
  local page
  page=$(IFS=-; echo "tenebra${*:+-$*}")
  help2man --no-info --no-discard-stderr --version-string="tenebra $version" \
    --name="$("$build/bin/tenebra" "$@" --help | sed -n '1s/^tenebra: //; 1p')" \
    "$build/bin/tenebra${*:+ $*}" | sed "s|$build/bin/||g" |
    gzip -9n > "$share/man/man1/$page.1.gz"
}
manual
for command in view render info convert bake sun compare log verify trade; do manual "$command"; done
for part in merge summary report; do manual log "$part"; done
packaging/completions.py "$build/bin/tenebra" "$share"

(cd "$build" && cpack -G DEB -D CPACK_PACKAGE_CONTACT="$maintainer" > /dev/null)
ls -l "$build"/*.deb
if [[ "${1:-}" == --check ]]; then
  lintian --fail-on error "$build"/*.deb
fi
