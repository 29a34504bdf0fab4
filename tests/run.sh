#!/bin/sh
# Sets up, builds and runs every test. The last line is "N passed, N failed"; the exit code is 0 if none failed.
# Arguments go to ctest, e.g. -R foam.
set -u
cd "$(dirname "$0")/.." || exit 1

if ! { sh apps/setup.sh && sh apps/build.sh; }; then
  echo "The build failed."
  echo "0 passed, 1 failed"
  exit 1
fi
log=build/tests.log
ctest --test-dir build --output-on-failure -j "$(nproc)" "$@" 2>&1 | tee "$log"

# ctest closes with "P% tests passed, F tests failed out of N".
counts=$(sed -n 's/^[0-9]*% tests passed, \([0-9]*\) tests* failed out of \([0-9]*\)$/\1 \2/p' "$log" | tail -n 1)
if [ -z "$counts" ]; then
  echo "0 passed, 1 failed"
  exit 1
fi
failed=${counts% *}
total=${counts#* }
echo "$((total - failed)) passed, $failed failed"
[ "$failed" -eq 0 ]
