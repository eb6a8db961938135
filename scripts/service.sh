#!/usr/bin/env bash
# Measures what watchers cost a server, one of them stopped for a minute, and what publishing costs, and writes docs/service.md: five
# minutes, on a machine that does nothing else.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh service_bench
tables=$(build/release/bin/service_bench "${1:-60}")
{
  sed '/^<!-- tables -->$/q' docs/service.md
  printf '\n%s\n' "$tables"
} > docs/service.md.new
mv docs/service.md.new docs/service.md
