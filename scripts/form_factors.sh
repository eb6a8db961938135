#!/usr/bin/env bash
# Measures every method of computing form factors against exact values, and the whole matrix of a scene: docs/form-factors.md.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh form_factor_table concentric_cubes alvor

bin=build/release/bin page=docs/form-factors.md
mkdir -p out
"$bin/form_factor_table" tests/truth/form_factors.csv > "$page"
"$bin/concentric_cubes" 16 10 0.5 > out/cubes.obj
{
  echo
  echo "## A whole matrix"
  echo
  echo "\`alvor form-factors\` on a cube around a cube, 1 920 quads. It is closed, so row sums are 1. Matrices are written row by row and never"
  echo "held whole. Where a shadow's edge crosses faces their own errors are larger than those of the sums; see the bounds."
  for threads in 1 2; do
    printf '\n    %s\n' "--threads $threads"
    "$bin/alvor" form-factors out/cubes.obj -o out/cubes.csv --threads "$threads" | grep -v wrote | sed 's/^/    /'
  done
} >> "$page"
echo "wrote $page"
