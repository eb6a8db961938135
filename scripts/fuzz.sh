#!/usr/bin/env bash
# fuzz.sh [SECONDS [SEED]]: feeds made-up bytes to all that reads what others send or wrote, each for so long (300), drawn from the
# seed (0: another one each time), under AddressSanitizer and UBSan. What they find goes to build/fuzz/found; what was interesting is
# kept in build/fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
targets=(scene_upload frame watch checkpoint file web edit)
PRESET=fuzz scripts/build.sh seeds "${targets[@]/%/_fuzz}"
cd build/fuzz
mkdir -p found
bin/seeds seeds ../../tests/client/{good,bad}_files/* ../../tests/import/blender/files/* ../../scenes/cornell_box.* ../../scenes/luminaires/*
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0 UBSAN_OPTIONS=halt_on_error=1
fuzz() {
  local target=$1 length=$2 megabytes=$3
  mkdir -p "corpus/$target"
  "bin/${target}_fuzz" -max_total_time="$seconds" -seed="$seed" -max_len="$length" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb="$megabytes" \
    -artifact_prefix="found/$target-" -print_final_stats=1 -verbosity=0 "corpus/$target" "seeds/$target" 2> "found/$target.log" ||
    { tail -40 "found/$target.log"; echo "$target: see build/fuzz/found" >&2; exit 1; }
  echo "$target: $(sed -n 's/stat::number_of_executed_units: *//p' "found/$target.log") inputs"
}
seconds=${1:-300} seed=${2:-0}
# Longest input, and the largest single allocation in MB (the targets allow less where our own code is at work).
fuzz scene_upload 65536 64 & first=$!
fuzz frame 65536 64
wait $first
fuzz watch 2048 16 & first=$!
fuzz checkpoint 1000000 64
wait $first
fuzz file 131072 64 & first=$!
fuzz web 16384 64
wait $first
fuzz edit 4096 64
