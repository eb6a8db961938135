#!/usr/bin/env bash
# Compares the strategies on two rooms; renews the figures of docs/strategies.md in docs/strategies/, prints its tables.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvor

command -v montage > /dev/null || { echo "strategies: needs montage, of the package imagemagick" >&2; exit 1; }

docs=docs/strategies
mkdir -p "$docs"

# room NAME SCENE TOLERANCE
room() {
  local out=out/strategies/$1
  echo "$2 at tolerance $3"
  build/release/bin/alvor compare "$2" -o "$out" --steps 100 --tolerance "$3"
  for plot in rms_per_step rms_per_second; do cp "$out/$plot.png" "$docs/$1_$plot.png"; done
  local pictures=()
  for strategy in gather shoot sorted sorted+ambient overshoot converged; do
    pictures+=(-label "$strategy" "$out/$strategy.png")
  done
  montage "${pictures[@]}" -resize 300x225 -geometry +3+3 -tile 3x -depth 8 -strip "$docs/$1.png"
}

room cornell_box scenes/cornell_box.obj 0.02
room furnished_room scenes/furnished_room.obj 0.05
