#!/bin/sh
# Do births depend on the grid, the step or the markers? Runs the pouring scene with each changed in turn and prints, for
# the steady pour (0.8 s to 3.5 s), births a second, the radii's median and spread, and their ratio to the first row.
# Usage: sh tests/accuracy/births.sh [FOLDER]   (about 15 minutes on 2 cores; needs build/apps/spume)
set -eu
cd "$(dirname "$0")/../.."
out=${1:-out/births}
spume=build/apps/spume
from=0.8
to=3.5

variant() {
  name=$1
  shift
  "$spume" run data/scenes/pouring.toml -o "$out/$name" --frames 105 --no-preview --restart \
    --set output.liquid=false --set output.bubbles_vdb=false --set output.bubbles_ply=false "$@" >"$out/$name.log"
  awk -F, -v from=$from -v to=$to '
    NR == 1 { for (c = 1; c <= NF; ++c) column[$c] = c; next }
    $column["kind"] == "birth" && $column["time"] > from && $column["time"] <= to { print $column["radius"] }
  ' "$out/$name/events.csv" | sort -g | awk -v name="$name" -v from=$from -v to=$to -v first="$out/first" '
    { radius[NR] = $1 }
    END {
      rate = NR / (to - from)
      if ((getline base < first) <= 0) { base = rate; print rate > first }
      printf "| %s | %.0f | %.2f | %.3f | %.3f | %.3f |\n", name, rate, rate / base,
        1e3 * radius[int(NR * 0.1) + 1], 1e3 * radius[int(NR / 2) + 1], 1e3 * radius[int(NR * 0.9) + 1]
    }'
}

mkdir -p "$out"
rm -f "$out/first"
echo "| variant | births/s | ratio | r 10 % [mm] | r 50 % [mm] | r 90 % [mm] |"
echo "|---|---|---|---|---|---|"
variant standard
variant resolution_48 --set domain.resolution=48
variant step_5ms --set time.max_step=0.005 --set time.min_step=0.005
variant markers_64 --set liquid.markers_per_cell=64
