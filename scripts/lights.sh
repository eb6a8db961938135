#!/usr/bin/env bash
# Solves ten rooms with different lights to 5 %, measures their errors by path tracing, and prints the table of docs/lights.md: some
# minutes, most of them path tracing. Solutions and reports stay in out/lights.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvor

alvor=build/release/bin/alvor out=out/lights luminaires=scenes/luminaires rooms=docs/lights blender=tests/import/blender/files
mkdir -p "$out"

# field NAME FILE: the first number of this name in a JSON report.
field() { sed -n "s/^ *\"$1\": \([0-9.e+-]*\),*\$/\1/p" "$2" | head -1; }

# Furniture that nearly touches a surface needs many points, light through a window many paths.
furnished=(--points 20000 --paths 250) windows=(--points 4000 --paths 4000)
samples=("${furnished[@]}")

# room NAME SCENE LIGHTS...
number=0
room() {
  number=$((number + 1))
  local name=$1 scene=$2 file=$out/$number
  shift 2
  "$alvor" solve "$scene" "$@" --quiet --tolerance 0.05 --time-limit 120 -o "$file.glb" --json > "$file.solve.json"
  "$alvor" verify "$scene" "$file.glb" "$@" --quiet "${samples[@]}" --json > "$file.verify.json"
  awk -v name="$name" -v estimate="$(field estimated_error "$file.solve.json")" -v cpu="$(field cpu_s "$file.solve.json")" \
    -v leaves="$(field leaves "$file.solve.json")" -v value="$(field value "$file.verify.json")" \
    -v low="$(field low "$file.verify.json")" -v high="$(field high "$file.verify.json")" 'BEGIN {
      ratio = value > 0 ? sprintf("%.2f", estimate / value) : "-"
      printf "| %s | %.1f %% | %.1f %% (%.1f to %.1f) | %s | %.2f | %d |\n",
        name, 100 * estimate, 100 * value, 100 * low, 100 * high, ratio, cpu, leaves }'
}

echo "| room and lights | estimated error | measured error (95 % interval) | ratio | CPU seconds | leaves |"
echo "|---|---|---|---|---|---|"
room "Cornell box, emitting face" scenes/cornell_box.obj
room "furnished room, emitting faces" scenes/furnished_room.obj
panel=$luminaires/panel.ies
room "office, four panels (LM-63)" $rooms/office.obj --quantity photometric --luminaire "$panel@1.5,2.79,1.5" \
  --luminaire "$panel@4.5,2.79,1.5" --luminaire "$panel@1.5,2.79,3.5" --luminaire "$panel@4.5,2.79,3.5"
pendant=$luminaires/pendant.ldt
room "office, two pendants (EULUMDAT)" $rooms/office.obj --quantity photometric --luminaire "$pendant@1.6,2.2,1.5" \
  --luminaire "$pendant@4.4,2.2,3.5:90,0,0"
samples=("${windows[@]}")
room "window, overcast sky" $rooms/window.obj --quantity photometric --sky overcast
room "window, sun, clear sky, ground" $rooms/window.obj --quantity photometric --sun 25,32 --sky clear --ground 0.2
room "window, sun, sky of Perez" $rooms/window.obj --quantity photometric --sun 340,20 --sky perez:400,150
samples=("${furnished[@]}")
room "Blender's room: point, spot, sun, emitting faces" $blender/room.glb --light-scale 0.001464
room "Blender's room, lamps 683 times as bright" $blender/room_extras.gltf
room "sphere, soft spot, two downlights (EXT_lights_ies)" $rooms/lamps.gltf
