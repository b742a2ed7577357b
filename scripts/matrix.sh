#!/usr/bin/env bash
# Builds and tests the package with several versions of CGAL and Eigen, compilers, language standards
# and build types, and prints a table. Nothing is installed: headers come as Debian packages from
# Debian's suites and are unpacked below build/matrix. Runs on Debian 12 or later, with g++, clang++,
# CMake, make and what scripts/install_dependencies.sh installs.
#
#   matrix.sh [options] [pattern...]
#
#   pattern            run the configurations whose names match one of these shell patterns ('sid*')
#   -R regex           only the tests whose names match; only what they need is built
#   -j jobs            compiler processes and tests at once (1; each wants up to 2 GiB)
#   -f                 run again what was green already for the same sources
#   -l                 list the configurations, run nothing
#
# A configuration that was green is not run again until the sources, the tests asked for or the
# headers have changed. The table is in build/matrix/table.md, of each configuration there are the
# output of its build and of its tests beside its folder. Exit code: 0 if all that were asked for are
# green.
set -euo pipefail

# CGAL and Eigen by the suite of Debian that they come from: 12 is bookworm, 13 trixie, unstable sid.
# Every value of every axis; and all pairs of values but TBB with Eigen 3.4, which scripts/test.sh
# runs on Debian 12, and no TBB with Eigen 5.
# name                           CGAL      Eigen   compiler  C++  TBB  build type
configurations=(
  "sid-eigen5-gcc                sid       sid     g++       20   ON   Release"
  "trixie-eigen3-clang-notbb     trixie    trixie  clang++   20   OFF  Release"
  "bookworm-eigen3-gcc-debug     bookworm  trixie  g++       20   OFF  Debug"
  "bookworm-eigen5-clang         bookworm  sid     clang++   17   ON   Release"
  "sid-eigen3-clang-debug        sid       trixie  clang++   17   OFF  Debug"
  "trixie-eigen5-gcc-debug       trixie    sid     g++       17   ON   Debug"
)
# Debug keeps the assertions of CGAL, Eigen and the package. With -O0 the tests would run for hours.
debug_flags="-O1"

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$root/build/matrix
test_regex=.
jobs=1
force=0
list=0
while getopts "R:j:flh" option; do
  case $option in
    R) test_regex=$OPTARG ;;
    j) jobs=$OPTARG ;;
    f) force=1 ;;
    l) list=1 ;;
    h) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
patterns=("${@:-*}")

selected=()
for line in "${configurations[@]}"; do
  for pattern in "${patterns[@]}"; do
    # shellcheck disable=SC2053 # a pattern it is
    if [[ ${line%% *} == $pattern ]]; then
      selected+=("$line")
      break
    fi
  done
done
if [ "${#selected[@]}" -eq 0 ]; then
  echo "matrix.sh: no configuration matches ${patterns[*]}" >&2
  exit 2
fi
if [ "$list" = 1 ]; then
  printf '%s\n' "${selected[@]}"
  exit 0
fi
mkdir -p "$work"

# --- headers -----------------------------------------------------------------------------------

# apt with folders of its own: this machine's lists, packages and settings stay as they are
own_apt() {
  local suite=$1 command=$2
  shift 2
  "$command" -q \
    -o Dir::Etc::SourceList="$work/apt/$suite/matrix.sources" -o Dir::Etc::SourceParts=/dev/null \
    -o Dir::State="$work/apt/$suite/state" -o Dir::State::status=/dev/null \
    -o Dir::Cache="$work/apt/$suite/cache" \
    -o APT::Sandbox::User="$(id -un)" "$@"
}

# use_suite <suite> <keyring>
use_suite() {
  local mirror
  # where this machine gets its own release from; updates and security have a dash in their names
  mirror=$(apt-get indextargets --format '$(RELEASE) $(SITE)' |
    awk '$1 !~ /[-\/]/ && !found { print $2; found = 1 }')
  if [ -z "$mirror" ]; then
    echo "matrix.sh: apt has no mirror of Debian on this machine" >&2
    return 1
  fi
  mkdir -p "$work/apt/$1/state/lists/partial" "$work/apt/$1/cache/archives/partial"
  printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: main\nSigned-By: %s\n' \
    "$mirror" "$1" "$2" >"$work/apt/$1/matrix.sources"
  # without the error mode, lists whose signature is wrong would be a warning
  if ! own_apt "$1" apt-get update -o APT::Update::Error-Mode=any; then
    echo "matrix.sh: no lists of $1 whose signature can be verified with $2" >&2
    return 1
  fi
}

# fetch <suite> <package>: unpacks it into $work/headers/<suite>/<package>
fetch() {
  local suite=$1 package=$2 target=$work/headers/$1/$2
  local keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  if [ -e "$target" ]; then
    return 0
  fi
  if [ "$suite" = sid ]; then
    # The keys of unstable may be newer than this machine. Those of the newest release are in a
    # package of that release, which the keys of this machine vouch for.
    fetch trixie debian-archive-keyring
    keyring=$work/headers/trixie/debian-archive-keyring$keyring
  fi
  echo "matrix.sh: $package of $suite"
  use_suite "$suite" "$keyring"
  rm -rf "$work/apt/$suite/download" "$target.part"
  mkdir -p "$work/apt/$suite/download" "$target.part"
  (cd "$work/apt/$suite/download" && own_apt "$suite" apt-get download "$package")
  dpkg-deb -x "$work/apt/$suite"/download/*.deb "$target.part"
  # renamed when whole: an interrupted download leaves nothing half-filled
  mv "$target.part" "$target"
}

# --- one configuration ---------------------------------------------------------------------------

cgal_version() {
  sed -n 's/^#define CGAL_VERSION \([0-9.]*\).*/\1/p' "$1/usr/include/CGAL/version.h"
}

eigen_version() {
  sed -n 's/^set *(PACKAGE_VERSION "\([0-9.]*\)").*/\1/p' \
    "$1/usr/share/eigen3/cmake/Eigen3ConfigVersion.cmake"
}

# all that a result hangs on
fingerprint() {
  local code=(CMakeLists.txt cmake include test examples benchmark)
  cd "$root"
  git ls-files -s -- "${code[@]}"
  git diff HEAD -- "${code[@]}"
  git ls-files -o --exclude-standard -- "${code[@]}" | while read -r file; do
    git hash-object "$file"
  done
  echo "$* $debug_flags $test_regex"
}

# tests_of <build folder> <regex>
tests_of() {
  ctest --test-dir "$1" -N -R "$2" | sed -n 's/^ *Test *#[0-9]*: //p'
}

# the programs that the tests run are called as the tests are
targets_of() {
  local known name
  known=$(cmake --build "$1" --target help | sed -n 's/^\.\.\. //p')
  for name in $(tests_of "$1" "$test_regex"); do
    grep -x -F -e "$name" -e "${name%_without_data}" <<<"$known" || true
  done | sort -u
}

run() {
  local name=$1 cgal=$work/headers/$2/libcgal-dev eigen=$work/headers/$3/libeigen3-dev
  local compiler=$4 standard=$5 tbb=$6 type=$7
  local build=$work/$name result=$work/$name.result
  local cgal_dir key begin build_time test_time total passed left_out targets
  fetch "$2" libcgal-dev
  fetch "$3" libeigen3-dev
  cgal_dir=$(echo "$cgal"/usr/lib/*/cmake/CGAL)

  local columns
  columns="$name | $(cgal_version "$cgal") | $(eigen_version "$eigen")"
  columns+=" | $compiler $("$compiler" -dumpfullversion -dumpversion) | $standard | $tbb | $type"
  key=$(fingerprint "$columns" | git hash-object --stdin)
  if [ "$force" = 0 ] && [ "$(sed -n 1p "$result" 2>/dev/null)" = "green $key" ]; then
    echo "$name: green already"
    return 0
  fi
  echo "$name"
  rm -f "$result"
  # written last, unless something fails
  printf 'red %s\n| %s | %s | | |\n' "$key" "$columns" "does not build" >"$result"

  if [ ! -e "$work/data/meshes" ] && [ -e /usr/share/doc/libcgal-dev/data.tar.gz ]; then
    tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$work" data/meshes
  fi
  # --fresh is too new for this
  rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles"
  cmake -S "$root" -B "$build" -G "Unix Makefiles" \
    -D CGAL_DIR="$cgal_dir" -D Eigen3_DIR="$eigen/usr/share/eigen3/cmake" \
    -D CMAKE_CXX_COMPILER="$compiler" -D CMAKE_CXX_STANDARD="$standard" \
    -D CMAKE_BUILD_TYPE="$type" -D CMAKE_CXX_FLAGS_DEBUG="$debug_flags" \
    -D RCO_WITH_TBB="$tbb" -D RCO_WERROR=ON -D RCO_DATA_DIR="$work/data/meshes" \
    >"$work/$name.build.txt" 2>&1 || { tail -20 "$work/$name.build.txt"; return 1; }

  targets=$(targets_of "$build")
  begin=$SECONDS
  if [ -n "$targets" ]; then
    # shellcheck disable=SC2086 # one word a target
    cmake --build "$build" --parallel "$jobs" --target $targets >>"$work/$name.build.txt" 2>&1 ||
      { grep -A 5 -m 5 -E 'error:|Error ' "$work/$name.build.txt"; return 1; }
  fi
  build_time=$((SECONDS - begin))
  # the compiler would take a header that the newer version no longer has from an installed one
  if find "$build" -name '*.d' -exec grep -l -E ' /usr/include/(CGAL|eigen3)/' {} + | grep .; then
    echo "$name: these were compiled with headers of this system instead of those in $work" >&2
    printf 'red %s\n| %s | %s | | |\n' "$key" "$columns" "headers of the system" >"$result"
    return 1
  fi

  begin=$SECONDS
  ctest --test-dir "$build" -R "$test_regex" --output-on-failure --no-tests=error --parallel "$jobs" \
    >"$work/$name.tests.txt" 2>&1 || true
  test_time=$((SECONDS - begin))
  total=$(tests_of "$build" "$test_regex" | wc -l)
  left_out=$(($(tests_of "$build" . | wc -l) - total))
  passed=$(grep -c -E '^ *[0-9]+/[0-9]+ Test +#.* Passed ' "$work/$name.tests.txt" || true)
  local state=red
  if [ "$passed" -eq "$total" ] && [ "$total" -gt 0 ]; then
    state=green
  else
    sed -n '/^The following tests/,$p' "$work/$name.tests.txt"
  fi
  passed+=" of $total"
  if [ "$left_out" -gt 0 ]; then passed+=", $left_out not run"; fi
  printf '%s %s\n| %s | %s | %s min | %s min |\n' "$state" "$key" "$columns" "$passed" \
    "$(minutes "$build_time")" "$(minutes "$test_time")" >"$result"
  [ "$state" = green ]
}

minutes() {
  awk -v seconds="$1" 'BEGIN { printf "%.1f", seconds / 60 }'
}

write_table() {
  local line name
  echo "| Configuration | CGAL | Eigen | Compiler | C++ | TBB | Build type | Passed | Build | Tests |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  for line in "${configurations[@]}"; do
    name=${line%% *}
    if [ -e "$work/$name.result" ]; then
      sed -n 2p "$work/$name.result"
    fi
  done
}

main() {
  local line status failed=0
  for line in "${selected[@]}"; do
    set +e # in a condition, run would go on after an error
    # shellcheck disable=SC2086 # its words are the arguments
    (set -e; run $line)
    status=$?
    set -e
    if [ "$status" -ne 0 ]; then failed=1; fi
    write_table >"$work/table.md"
  done
  cat "$work/table.md"
  exit "$failed"
}
main
