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
#   -f                 run again what has passed already for the same sources
#   -l                 list the configurations, run nothing
#
# Tests that have passed are not run again until the sources or the versions change, so that the
# matrix can be run in parts. The table is in build/matrix/table.md; what compilers and tests printed is
# beside each configuration's folder. Exit code: 0 if all tests asked for have passed.
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
# flags_for <build type> <compiler>
flags_for() {
  case "$1 $2" in
    # with -O1 gcc takes a register that Eigen 5 has filled for one that it has not
    Debug\ g++*) echo "-O1 -Wno-maybe-uninitialized" ;;
    Debug*) echo "-O1" ;;
  esac
}

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

# the state of all files that results depend on
fingerprint() {
  cd "$root"
  find CMakeLists.txt cmake include test examples benchmark -type f -print0 |
    LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1
}

# tests_of <build folder> <regex>
tests_of() {
  ctest --test-dir "$1" -N -R "$2" | sed -n 's/^ *Test *#[0-9]*: //p'
}

# targets_of <build folder> <tests>: the programs that tests run are called as the tests are
targets_of() {
  local known name
  known=$(cmake --build "$1" --target help | sed -n 's/^\.\.\. //p')
  for name in $2; do
    grep -x -F -e "$name" -e "${name%_without_data}" <<<"$known" || true
  done | sort -u
}

# Results are in one file a configuration: the fingerprint and the configuration, then lines
# 'versions <columns>', 'known <test>', 'passed <test>', 'failed <test>', 'build <seconds>',
# 'tests <seconds>' and 'broken <why>'.
names() {
  sed -n "s/^$1 //p" "$2" 2>/dev/null | sort -u
}

forget() {
  sed -i "/^$1/d" "$2"
}

configure() {
  local name=$1 cgal=$2 eigen=$3 compiler=$4 standard=$5 tbb=$6 type=$7
  if [ ! -e "$work/data/meshes" ] && [ -e /usr/share/doc/libcgal-dev/data.tar.gz ]; then
    tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$work" data/meshes
  fi
  # a cache would keep what was found the last time
  rm -rf "$work/$name/CMakeCache.txt" "$work/$name/CMakeFiles"
  cmake -S "$root" -B "$work/$name" -G "Unix Makefiles" \
    -D CGAL_DIR="$(echo "$cgal"/usr/lib/*/cmake/CGAL)" -D Eigen3_DIR="$eigen/usr/share/eigen3/cmake" \
    -D CMAKE_CXX_COMPILER="$compiler" -D CMAKE_CXX_STANDARD="$standard" \
    -D CMAKE_BUILD_TYPE="$type" -D CMAKE_CXX_FLAGS_DEBUG="$(flags_for "$type" "$compiler")" \
    -D RCO_WITH_TBB="$tbb" -D RCO_WERROR=ON -D RCO_DATA_DIR="$work/data/meshes"
}

run() {
  local name=$1 cgal=$work/headers/$2/libcgal-dev eigen=$work/headers/$3/libeigen3-dev
  local compiler=$4 standard=$5 tbb=$6 type=$7
  local build=$work/$name result=$work/$name.result log=$work/$name
  local columns key wanted targets begin
  fetch "$2" libcgal-dev
  fetch "$3" libeigen3-dev

  columns="$name | $(cgal_version "$cgal") | $(eigen_version "$eigen")"
  columns+=" | $compiler $("$compiler" -dumpfullversion -dumpversion) | $standard | $tbb | $type"
  key="$sources $columns $(flags_for "$type" "$compiler")"
  if [ "$force" = 1 ] || [ "$(sed -n 1p "$result" 2>/dev/null)" != "$key" ] ||
    ! grep -q '^known ' "$result"; then
    printf '%s\nversions %s\nbroken %s\n' "$key" "$columns" "not configured" >"$result"
    configure "$name" "$cgal" "$eigen" "$compiler" "$standard" "$tbb" "$type" \
      >"$log.build.txt" 2>&1 || { tail -20 "$log.build.txt"; return 1; }
    tests_of "$build" . | sed 's/^/known /' >>"$result"
    forget broken "$result"
  fi

  wanted=$(comm -23 <(tests_of "$build" "$test_regex" | sort) <(names passed "$result"))
  if [ -z "$wanted" ]; then
    echo "$name: has passed already"
    return 0
  fi
  echo "$name: $(tr '\n' ' ' <<<"$wanted")"

  forget broken "$result"
  echo "broken does not build" >>"$result"
  targets=$(targets_of "$build" "$wanted")
  begin=$SECONDS
  if [ -n "$targets" ]; then
    # targets that are named together would be built one after the other
    xargs -n 1 -P "$jobs" cmake --build "$build" --target <<<"$targets" >"$log.build.txt" 2>&1 ||
      { grep -A 5 -m 5 -E 'error:|Error ' "$log.build.txt"; return 1; }
  fi
  echo "build $((SECONDS - begin))" >>"$result"
  forget broken "$result"
  # the compiler would take a header that the newer version no longer has from an installed one
  if find "$build" -name '*.d' -exec grep -l -E ' /usr/include/(CGAL|eigen3)/' {} + | grep .; then
    echo "$name: these were compiled with headers of this system instead of those in $work" >&2
    echo "broken headers of the system" >>"$result"
    return 1
  fi

  begin=$SECONDS
  # shellcheck disable=SC2086 # one word a test
  ctest --test-dir "$build" -R "^($(echo $wanted | tr ' ' '|'))\$" --output-on-failure \
    --parallel "$jobs" >"$log.tests.txt" 2>&1 || true
  echo "tests $((SECONDS - begin))" >>"$result"
  local test failed=0
  for test in $wanted; do
    forget "failed $test\$" "$result"
    if grep -q -E "^ *[0-9]+/[0-9]+ Test +#[0-9]+: $test \.+ +Passed " "$log.tests.txt"; then
      echo "passed $test" >>"$result"
    else
      echo "failed $test" >>"$result"
      failed=1
    fi
  done
  if [ "$failed" = 1 ]; then sed -n '/^The following tests/,$p' "$log.tests.txt"; fi
  return "$failed"
}

minutes() {
  sed -n "s/^$1 //p" "$2" | awk '{ sum += $1 } END { printf "%.1f min", sum / 60 }'
}

row() {
  local result=$1 known passed failed status
  known=$(names known "$result" | wc -l)
  passed=$(names passed "$result" | wc -l)
  failed=$(names failed "$result" | wc -l)
  status=$(names broken "$result")
  if [ -z "$status" ]; then
    status="$passed of $known"
    if [ "$failed" -gt 0 ]; then status+=", $failed failed"; fi
    if [ $((passed + failed)) -lt "$known" ]; then status+=", the others not run"; fi
  fi
  if [ "$(sed -n '1s/ .*//p' "$result")" != "$sources" ]; then status+=" (older sources)"; fi
  echo "| $(names versions "$result") | $status | $(minutes build "$result") | $(minutes tests "$result") |"
}

write_table() {
  local line name
  echo "| Configuration | CGAL | Eigen | Compiler | C++ | TBB | Build type | Passed | Build | Tests |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  for line in "${configurations[@]}"; do
    name=${line%% *}
    if [ -e "$work/$name.result" ]; then row "$work/$name.result"; fi
  done
}

main() {
  local line status failed=0
  sources=$(fingerprint)
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
