#!/usr/bin/env bash
# Shows a real mesh getting better: installs what is missing, builds one example and runs it.
#
#   bash scripts/demo.sh [mesh in [mesh out]]
#
# Without arguments the mesh is CGAL's armadillo; the name of one of CGAL's meshes, such as
# elephant.off, will do too.
set -euo pipefail

calling_dir=$PWD
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
build=build/demo

# from where the user stands, not from the repository's root
absolute() {
  case "$1" in
    /*) printf '%s\n' "$1" ;;
    *) printf '%s\n' "$calling_dir/$1" ;;
  esac
}

bash scripts/install_dependencies.sh
if ! command -v make >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi

mkdir -p build
cmake -S . -B "$build" -D CMAKE_BUILD_TYPE=Release -D RCO_BUILD_EXAMPLES=ON \
  -D RCO_BUILD_TESTS=OFF -D RCO_BUILD_BENCHMARKS=OFF >"$build.log" 2>&1 || {
  cat "$build.log" >&2
  exit 1
}
echo "Building the example (a minute or two the first time) ..."
cmake --build "$build" --target minimum_angle_improvement

data_dir=$(sed -n 's/^RCO_DATA_DIR:[^=]*=//p' "$build/CMakeCache.txt")
input=${1:-armadillo.off}
if [ -e "$(absolute "$input")" ]; then
  input=$(absolute "$input")
elif [ -e "$data_dir/$input" ]; then
  input=$data_dir/$input
else
  echo "demo.sh: there is no mesh $input, neither here nor among CGAL's meshes ($data_dir)" >&2
  exit 1
fi
if [ $# -ge 2 ]; then
  output=$(absolute "$2")
else
  output=$root/$build/$(basename "${input%.*}")_improved.off
fi

echo
exec "$build/examples/Reference_constrained_optimization/minimum_angle_improvement" \
  "$input" "$output"
