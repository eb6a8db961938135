#!/usr/bin/env bash
# Measures error against run time of solves, textbook shooting and path tracing, and writes docs/error-vs-time.md with its plots: about
# half an hour, during which nothing else should run. Arguments go to error_vs_time (--help tells); --quick is a try-out of a
# minute. Truths are kept in out/ for the next run.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvor error_vs_time office_block

curves=out/error_vs_time figures=docs/error-vs-time
rm -f "$curves"/*.dat
mkdir -p "$curves/scenes"
for faces in 422 5000 50000; do
  build/release/bin/office_block --faces "$faces" -o "$curves/scenes/office_$faces.obj"
done
build/release/bin/error_vs_time "$@"
[ -f "$curves/estimates.dat" ] || exit 0  # it was only asked for help

mapfile -t scenes < <(sed -n 's/^# //p' "$curves/estimates.dat")
for scene in "${scenes[@]}"; do
  gnuplot -c bench/error_vs_time/scene.gnuplot "$curves/$scene.dat" "$figures/$scene.png" "$scene"
done
gnuplot -c bench/error_vs_time/estimates.gnuplot "$curves/estimates.dat" "$figures/estimates.png" "${scenes[*]}"
