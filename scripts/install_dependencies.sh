#!/usr/bin/env bash
# Installs, on Debian and Ubuntu, whatever this project needs and the machine does not have yet.
# Does nothing, and needs no rights, if everything is there.
#
# RCO_SKIP_INSTALL=1 turns it off: for other systems, or where the packages come from elsewhere.
set -euo pipefail

if [ "${RCO_SKIP_INSTALL:-0}" = 1 ]; then
  exit 0
fi

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  cat >&2 <<'END'
install_dependencies.sh: this is not a Debian or Ubuntu system (no apt-get).
Please install a C++17 compiler, CMake (3.21 or later), make or ninja, CGAL (5.5 or later) with its
data, Eigen (3.3.7 or later), Boost, GMP and MPFR; TBB, Boost.Program_options, Google Benchmark and
Python (3.9 or later) are optional.
Then run the script again with RCO_SKIP_INSTALL=1.
END
  exit 1
fi

data_archive=/usr/share/doc/libcgal-dev/data.tar.gz

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# names on standard output, one a line, of the packages that are missing
missing_packages() {
  local package
  # tools may come from anywhere
  command -v g++ >/dev/null || echo g++
  command -v cmake >/dev/null || echo cmake
  command -v make >/dev/null || command -v ninja >/dev/null || echo make
  command -v python3 >/dev/null || echo python3
  for package in libcgal-dev libcgal-demo libeigen3-dev libboost-dev libboost-program-options-dev \
                 libtbb-dev libbenchmark-dev libgmp-dev libmpfr-dev; do
    is_installed "$package" || echo "$package"
  done
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null; then
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  else
    echo "install_dependencies.sh: neither root nor sudo; as root, please run:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends ${packages[*]}" >&2
    return 1
  fi
}

mapfile -t packages < <(missing_packages)
# Small container images drop everything under /usr/share/doc, where Debian keeps CGAL's meshes
reinstall=()
if [ ! -e "$data_archive" ]; then
  if is_installed libcgal-demo; then
    packages+=(libcgal-demo)
    reinstall=(--reinstall)
  fi
fi
if [ "${#packages[@]}" -eq 0 ]; then
  exit 0
fi

echo "Installing: ${packages[*]}"
as_root apt-get update -qq
as_root apt-get install -qq -y --no-install-recommends "${reinstall[@]}" \
  -o Dpkg::Options::="--path-include=$(dirname "$data_archive")/*" "${packages[@]}"

mapfile -t packages < <(missing_packages)
if [ "${#packages[@]}" -ne 0 ]; then
  echo "install_dependencies.sh: still missing after the installation: ${packages[*]}" >&2
  exit 1
fi
if [ ! -e "$data_archive" ]; then
  echo "install_dependencies.sh: warning: $data_archive is not there," >&2
  echo "so there are no meshes to show or test with (see RCO_DATA_DIR in README.md)" >&2
fi
