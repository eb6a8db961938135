#!/usr/bin/env bash
# Measures what scenes save that can do without a part of the solver, and writes docs/plan.md: some minutes, most of them valgrind's,
# which counts instructions. Without valgrind that column stays empty.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh plan_table

table=build/release/bin/plan_table out=out/plan
mkdir -p "$out"
rm -f "$out/instructions.txt"
touch "$out/instructions.txt"

# count SCENE FORCED OPTIONS...
count() {
  local log=$out/callgrind.log
  valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='alvor::solve(*' --log-file="$log" \
    "$table" --solve "$1" "${@:3}"
  echo "$1 $2 $(sed -n 's/.*Collected : //p' "$log")" >> "$out/instructions.txt"
}

if command -v valgrind > /dev/null; then
  for scene in $("$table" --list); do
    count "$scene" 0
    count "$scene" 1 --forced
  done
fi
"$table" --instructions "$out/instructions.txt" > docs/plan.md
echo "wrote docs/plan.md"
