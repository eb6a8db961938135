#!/usr/bin/env bash
# Makes ten rooms in Blender (tests/import/blender/ten_rooms.py), solves them to 3 %, measures their errors by path tracing, and prints the
# table of docs/surfaces.md: some minutes, most of it path tracing. Rooms, solutions and reports stay in out/rooms.
# Needs Blender; the first run installs Debian's.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvor
if ! command -v blender > /dev/null || ! python3 -c "import numpy" 2> /dev/null; then
  apt-get update -qq
  apt-get install -y -qq --no-install-recommends blender python3-numpy
fi

alvor=build/release/bin/alvor out=out/rooms
mkdir -p "$out"
blender -b --factory-startup --python-exit-code 1 --python tests/import/blender/ten_rooms.py -- "$out" > "$out/blender.log"

lamps=(--light-scale 0.001464) # 1 / 683: Blender writes 683 cd for 1 W/sr

# field NAME FILE: the first number of this name in a JSON report.
field() { sed -n "s/^ *\"$1\": \([0-9.e+-]*\),*\$/\1/p" "$2" | head -1; }

echo "| room | estimated error | measured error (95 % interval) | ratio | bias (95 % interval) | CPU seconds | leaves |"
echo "|---|---|---|---|---|---|---|"
for number in 1 2 3 4 5 6 7 8 9 10; do
  file=$out/$number
  "$alvor" solve "$file.glb" "${lamps[@]}" --quiet --tolerance 0.03 --time-limit 120 -o "$file.solved.glb" --json > "$file.solve.json"
  "$alvor" render "$file.solved.glb" --quiet --width 720 --height 540 -o "$file.png"
  "$alvor" verify "$file.glb" "$file.solved.glb" "${lamps[@]}" --quiet --points 8000 --paths 3000 --json > "$file.verify.json"
  awk -v number=$number -v estimate="$(field estimated_error "$file.solve.json")" \
    -v cpu="$(field cpu_s "$file.solve.json")" -v leaves="$(field leaves "$file.solve.json")" \
    -v value="$(field value "$file.verify.json")" -v low="$(field low "$file.verify.json")" -v high="$(field high "$file.verify.json")" \
    -v bias="$(sed -n '/"bias"/,$p' "$file.verify.json" | field value /dev/stdin)" \
    -v bias_low="$(sed -n '/"bias"/,$p' "$file.verify.json" | field low /dev/stdin)" \
    -v bias_high="$(sed -n '/"bias"/,$p' "$file.verify.json" | field high /dev/stdin)" 'BEGIN {
      ratio = value > 0 ? sprintf("%.2f", estimate / value) : "-"
      printf "| %d | %.1f %% | %.1f %% (%.1f to %.1f) | %s | %.2f %% (%.2f to %.2f) | %.1f | %d |\n", number, 100 * estimate,
        100 * value, 100 * low, 100 * high, ratio, 100 * bias, 100 * bias_low, 100 * bias_high, cpu, leaves }'
done
