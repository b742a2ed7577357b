#!/usr/bin/env bash
# Makes the figures of the manual and the tables of its gallery from scratch: builds the programs,
# runs them on CGAL's meshes, and draws what comes out (a quarter of an hour).
#
#   bash scripts/make_figures.sh [--keep-runs] [figure...]
#
# --keep-runs takes results of the drivers from the last time. With names of figures, such as
# gallery_angle, only these are drawn.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
keeps_runs=0
if [ "${1:-}" = --keep-runs ]; then
  keeps_runs=1
  shift
fi

bash scripts/install_dependencies.sh
for tool in xvfb-run pngquant; do
  if ! command -v "$tool" >/dev/null; then
    echo "make_figures.sh: $tool is missing (Debian: apt-get install xvfb xauth pngquant)" >&2
    exit 1
  fi
done
# a Python of one's own may not see Debian's packages
python=
for candidate in python3 /usr/bin/python3; do
  if "$candidate" -c 'import vtkmodules, matplotlib' 2>/dev/null; then
    python=$candidate
    break
  fi
done
if [ -z "$python" ]; then
  echo "make_figures.sh: VTK or matplotlib for Python is missing" \
    "(Debian: apt-get install python3-vtk9 python3-matplotlib)" >&2
  exit 1
fi

build=build/release
cmake --preset release >/dev/null
cmake --build "$build" --parallel "${RCO_JOBS:-1}" --target rco_benchmark quad_benchmark \
  compatible_benchmark side_by_side method_pictures rco make_quad_mesh quad_mesh_optimization
if [ "$keeps_runs" = 0 ]; then
  rm -rf "$build/figures"
fi
xvfb-run -a "$python" scripts/figures/make.py "$build" "$@"
