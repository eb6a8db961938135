#!/usr/bin/env bash
# hostile.sh [--write] [--seconds N] [--front nginx] [--table FILE] [NAME...]: attacks alvord as strangers would, on the loopback: floods, slow readers,
# request smuggling, idle crowds, five tenants over one connection. Each flood lasts N seconds (1.5; at most 30); NAMEs are those of attacks or of
# families (tests/hostile). Behind nginx with --front nginx. --write attacks both ways, and puts what was seen into docs/security.md. ALVOR_BINARIES is
# where alvord is, if not in build/release/bin.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh test
[ -n "${ALVOR_BINARIES:-}" ] || { scripts/build.sh alvord && scripts/build_page.sh; }
attack() { /usr/bin/python3 -B tests/hostile/run.py "$@"; }

if [ "${1:-}" != --write ]; then
  attack "$@"
  exit
fi
shift
table=$(mktemp)
trap 'rm -f "$table"' EXIT
for front in none nginx; do
  attack "$@" --front $front --table "$table" || true # what was not held is in the table
  sed -i -e "/^<!-- seen: $front -->/,/^<!-- end -->/{//!d}" -e "/^<!-- seen: $front -->/r $table" docs/security.md
done
