#!/bin/sh
# Builds spume in build/: everything, or the targets named as arguments.
set -eu
cd "$(dirname "$0")/.."

# The largest files take about 2.2 GB each to compile.
memory_jobs=$(awk '/^MemTotal:/ { print int($2 / (2.2 * 1024 * 1024)) }' /proc/meminfo)
jobs=$(nproc)
[ "$memory_jobs" -ge "$jobs" ] || jobs=$memory_jobs
[ "$jobs" -ge 1 ] || jobs=1

if [ -f build/CMakeCache.txt ]; then
  cmake -S . -B build
else
  cmake -S . -B build -G Ninja
fi
if [ $# -gt 0 ]; then
  cmake --build build -j "$jobs" --target "$@"
else
  cmake --build build -j "$jobs"
fi
