#!/usr/bin/env bash
# Builds TBB with ThreadSanitizer into build/tsan-tbb, for the preset "tsan": the sanitizer does not
# see how a TBB without its instrumentation hands work to threads, and takes every task for a race.
#
#   bash scripts/build_tsan_tbb.sh [folder with oneTBB's sources]
#
# Without a folder the sources of Debian's or Ubuntu's own package are fetched with apt-get (no
# rights are needed, and the system's lists of packages stay as they are).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
target=$root/build/tsan-tbb
sources=${1:-$target/source}
mkdir -p "$target"

if [ ! -e "$sources/CMakeLists.txt" ]; then
  if [ $# -gt 0 ]; then
    echo "build_tsan_tbb.sh: no CMakeLists.txt in $sources" >&2
    exit 1
  fi
  fetch=$target/fetch
  mkdir -p "$fetch/lists/partial" "$fetch/cache/archives/partial" "$fetch/sources.list.d"
  # the system's sources of packages, asked for sources
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    if [ -f "$list" ]; then
      sed -n 's/^deb /deb-src /p' "$list" >"$fetch/sources.list.d/$(basename "$list" .list).list"
    fi
  done
  for list in /etc/apt/sources.list.d/*.sources; do
    if [ -f "$list" ]; then
      sed 's/^Types:.*/Types: deb-src/' "$list" >"$fetch/sources.list.d/$(basename "$list")"
    fi
  done
  options=(-o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$fetch/sources.list.d"
    -o "Dir::State::Lists=$fetch/lists" -o "Dir::Cache=$fetch/cache")
  cd "$fetch"
  apt-get "${options[@]}" update
  apt-get "${options[@]}" source --download-only onetbb
  rm -rf "$sources"
  dpkg-source --no-check -x onetbb_*.dsc "$sources"
fi

cmake -S "$sources" -B "$target/build" \
  -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" -DCMAKE_INSTALL_PREFIX="$target/install" \
  -DCMAKE_INSTALL_LIBDIR=lib -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF
cmake --build "$target/build" --parallel "${RCO_JOBS:-1}"
cmake --install "$target/build"
