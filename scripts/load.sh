#!/usr/bin/env bash
# Measures calls, connections, watches and stored scenes of one server, and writes the table into docs/service.md: a minute, on a machine that does
# nothing else.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvord
scripts/build_page.sh
table=$(mktemp)
trap 'rm -f "$table"' EXIT
/usr/bin/python3 -B bench/load/load.py | tee "$table"
sed -i -e "/^<!-- load -->$/,/^<!-- end of load -->$/{//!d}" -e "/^<!-- load -->$/r $table" docs/service.md
