#!/usr/bin/env bash
# Checks that every C++ file in git is formatted as .clang-format says; --fix formats them instead.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ! command -v clang-format >/dev/null; then
  echo "check_format.sh: clang-format is not installed, nothing checked"
  exit 0
fi

action=(--dry-run -Werror)
if [ "${1:-}" = --fix ]; then
  action=(-i)
fi
# no file yet is no error; the concept pages of the manual are C++ for Doxygen only
git ls-files -z -- '*.h' '*.cpp' ':!doc' | xargs -0 -r clang-format "${action[@]}"
