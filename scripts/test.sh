#!/usr/bin/env bash
# Installs what is missing, builds tests, examples and benchmarks in Release with warnings as
# errors (the preset "tests"), and runs all tests. Arguments are passed on to ctest.
# The last thing printed is ctest's summary; the exit code is ctest's.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
bash scripts/install_dependencies.sh
if ! command -v make >/dev/null; then
  export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}
fi

# CGAL's headers want up to 2 GiB per compiler process
number_of_jobs() {
  local cores memory limit jobs
  cores=$(nproc)
  memory=$(awk '/^MemTotal:/ { print int($2 / 1024) }' /proc/meminfo)
  # the memory that a container may use
  for limit in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
    if [ -r "$limit" ] && grep -qE '^[0-9]{1,15}$' "$limit"; then
      limit=$(($(cat "$limit") / 1048576))
      if [ "$limit" -lt "$memory" ]; then memory=$limit; fi
      break
    fi
  done
  jobs=$((memory / 2048))
  if [ "$jobs" -gt "$cores" ]; then jobs=$cores; fi
  if [ "$jobs" -lt 1 ]; then jobs=1; fi
  echo "$jobs"
}
jobs=$(number_of_jobs)

cmake --preset tests
cmake --build build/test --parallel "$jobs"

cd build/test
exec ctest --output-on-failure --no-tests=error --parallel "$jobs" "$@"
