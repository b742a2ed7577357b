#!/usr/bin/env bash
# Checks that every C++ file in git is formatted as .clang-format says; --fix formats them instead.
# Where there is no clang-format, or another version, whose ideas differ here and there, nothing is
# checked.
set -euo pipefail

version=14 # Debian 12's
cd "$(dirname "${BASH_SOURCE[0]}")/.."
formatter=""
for name in "clang-format-$version" clang-format; do
  if command -v "$name" >/dev/null && "$name" --version | grep -q "version $version\."; then
    formatter=$name
    break
  fi
done
if [ -z "$formatter" ]; then
  echo "check_format.sh: clang-format $version is not installed, nothing checked"
  exit 0
fi
# an unpacked archive
if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  echo "check_format.sh: git knows no files here, nothing checked"
  exit 0
fi

action=(--dry-run -Werror)
if [ "${1:-}" = --fix ]; then
  action=(-i)
fi
# no file yet is no error; the concept pages of the manual are C++ for Doxygen only
git ls-files -z -- '*.h' '*.cpp' ':!doc' | xargs -0 -r "$formatter" "${action[@]}"
