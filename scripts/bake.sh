#!/usr/bin/env bash
# Measures `alvor bake` beside Blender's Cycles: the same room, texels and light. Prints a table of error against CPU seconds and leaves it in
# out/bake/table.md. Takes about a quarter of an hour, during which nothing else should run. Installs Blender.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
command -v blender > /dev/null || { [ "$(id -u)" = 0 ] && apt-get install -y -q blender || sudo apt-get install -y -q blender; } > /dev/null
scripts/build.sh alvor

out=out/bake scene=scenes/furnished_room.obj
rm -rf "$out"
mkdir -p "$out"
for tolerance in 0.1 0.05 0.02; do
  TIMEFORMAT='%U %S'
  { time build/release/bin/alvor bake "$scene" -o "$out/room.glb" --size 512 --lightmap-format exr --convention godot \
      --tolerance "$tolerance" --max-elements 1000000 --threads 1 --quiet; } 2> "$out/times"
  tail -1 "$out/times" | awk '{ print $1 + $2 }' > "$out/$tolerance.cpu"
  mv "$out/room-0.exr" "$out/$tolerance.exr"
done
blender -b --python bench/bake/cycles_bake.py -- "$out" "$out/table.md" | grep -E '^\||texels;|Error' || { echo "bake: Blender failed" >&2; exit 1; }
