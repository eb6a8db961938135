#!/usr/bin/env bash
# random_scenes.sh [SCENES [FIRST]]: solves random scenes (10 000 from the first) under AddressSanitizer and
# UndefinedBehaviorSanitizer. Prints each that breaks an invariant, shrunk, as OBJ, MTL and a command; fails if any does.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
PRESET=asan scripts/build.sh random_scenes_test
export ASAN_OPTIONS=abort_on_error=1 UBSAN_OPTIONS=abort_on_error=1:print_stacktrace=1
build/asan/bin/random_scenes_test --scenes "${1:-10000}" --first "${2:-1}"
