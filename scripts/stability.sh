#!/usr/bin/env bash
# Measures stiff and extreme scenes against closed forms and dense solutions, and writes docs/stability.md: about a minute.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh stability
build/release/bin/stability docs/stability.md
