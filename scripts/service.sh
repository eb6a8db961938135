#!/usr/bin/env bash
# Measures what watchers cost a server, one of them stopped for a minute, and what publishing costs, and writes docs/service.md: five
# minutes, on a machine that does nothing else.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh service_bench
tables=$(build/release/bin/service_bench "${1:-60}")
file=$(mktemp)
trap 'rm -f "$file"' EXIT
printf '\n%s\n\n' "$tables" > "$file"
sed -i -e "/^<!-- tables -->$/,/^<!-- end of tables -->$/{//!d}" -e "/^<!-- tables -->$/r $file" docs/service.md
