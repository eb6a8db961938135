#!/usr/bin/env bash
# Sets up the machine, builds everything, runs all tests and feeds made-up bytes to what reads foreign ones. Arguments go to CTest.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh
ctest --preset release "$@"
scripts/fuzz.sh 20 1
