#!/usr/bin/env bash
# build.sh [TARGET...]: configures with the preset $PRESET (release) and $CMAKE_OPTIONS and builds, quietly unless something is wrong.
set -euo pipefail
cd "$(dirname "$0")/.."

log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() { "$@" > "$log" 2>&1 || { cat "$log" >&2; exit 1; }; }

# What was compiled in one checkout need not be in another, nor in an image: ccache looks at the language of messages too, and it mistrusts
# headers as young as those that the build has just generated.
export LANG=C.UTF-8
unset LC_ALL LC_CTYPE LC_MESSAGES
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros,include_file_mtime,include_file_ctime} CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
preset=${PRESET:-release}
echo "Building (the first time takes some minutes)"
read -ra options <<< "${CMAKE_OPTIONS:-}"
quietly cmake --preset "$preset" "${options[@]}"
quietly cmake --build --preset "$preset" ${1:+--target "$@"}
