#!/usr/bin/env bash
# Builds the manual into build/doc/html with Doxygen. Warnings are shown and kept in
# build/doc/warnings.txt; --strict turns them, links to what is not there and figures that no page
# shows into a failure.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ! command -v doxygen >/dev/null; then
  echo "build_doc.sh: doxygen is not installed (Debian: apt-get install doxygen)" >&2
  exit 1
fi

doxyfile=doc/Reference_constrained_optimization/Doxyfile
mkdir -p build/doc
{
  cat "$doxyfile"
  # a local MathJax (Debian: libjs-mathjax) makes the pages readable without a network
  if [ -e /usr/share/javascript/mathjax/MathJax.js ]; then
    echo "MATHJAX_RELPATH = file:///usr/share/javascript/mathjax"
  fi
} | doxygen - >build/doc/doxygen.log
cat build/doc/warnings.txt >&2
echo "The manual is build/doc/html/index.html"
is_clean=1
[ ! -s build/doc/warnings.txt ] || is_clean=0
if command -v python3 >/dev/null; then
  python3 scripts/check_links.py build/doc/html "$(dirname "$doxyfile")/fig" >&2 || is_clean=0
fi
if [ "${1:-}" = --strict ] && [ "$is_clean" = 0 ]; then
  exit 1
fi
