#!/usr/bin/env bash
# build.sh [TARGET...]: configures with the preset $PRESET (release) and builds, quietly unless something is wrong.
set -euo pipefail
cd "$(dirname "$0")/.."

log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() { "$@" > "$log" 2>&1 || { cat "$log" >&2; exit 1; }; }

export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}
preset=${PRESET:-release}
echo "Building (the first time takes some minutes)"
quietly cmake --preset "$preset"
quietly cmake --build --preset "$preset" ${1:+--target "$@"}
