#!/usr/bin/env bash
# Checks that every header of the package compiles when it is the only one that is included.
#
#   check_headers.sh COMPILER [OPTION...]      e.g. g++ -std=c++17 -I/usr/include/eigen3
#
# Headers of other libraries are compiled once, for all: what is missing of those is not found.
set -euo pipefail

include="$(cd "$(dirname "${BASH_SOURCE[0]}")/../include" && pwd)"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$include"
mapfile -t headers < <(find CGAL -name '*.h' | sort)
compile=("$@" "-I$include" -fsyntax-only -w)

# some are there in some versions of CGAL only
grep -h '^#include <' "${headers[@]}" | grep -v -e Reference_constrained -e '<tbb/' | sort -u |
  sed -E 's/#include (<.*>)/#if __has_include(\1)\n&\n#endif/' >"$folder/others.h"
if ! "$@" "-I$include" -w -x c++-header "$folder/others.h" -o "$folder/others.h.gch"; then
  echo "check_headers.sh: the headers of other libraries do not compile" >&2
  exit 1
fi

check() {
  local source="$folder/${1//\//_}.cpp"
  echo "#include <$1>" >"$source"
  if ! "${compile[@]}" -include "$folder/others.h" "$source"; then
    echo "check_headers.sh: $1 does not compile by itself" >&2
    return 1
  fi
}

number=0
failures=0
for header in "${headers[@]}"; do
  if ((number++ >= $(nproc))); then
    wait -n || failures=$((failures + 1))
  fi
  check "$header" &
done
while [ -n "$(jobs -p)" ]; do
  wait -n || failures=$((failures + 1))
done
echo "check_headers.sh: ${#headers[@]} headers, $failures do not compile by themselves"
[ "$failures" -eq 0 ]
