#!/usr/bin/env bash
# Sets up the machine, builds everything and runs all tests. Arguments go to CTest.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh
ctest --preset release "$@"
