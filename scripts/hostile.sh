#!/usr/bin/env bash
# hostile.sh [--seconds N] [--front nginx] [--table FILE] [NAME...]: attacks alvord as strangers would, on the loopback: floods, slow readers, request
# smuggling, idle crowds, five tenants over one connection. Each flood lasts N seconds (1.5; at most 30); NAMEs are those of attacks or of families
# (tests/hostile). Behind nginx with --front nginx. ALVOR_BINARIES is where alvord is, if not in build/release/bin.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh test
[ -n "${ALVOR_BINARIES:-}" ] || { scripts/build.sh alvord && scripts/build_page.sh; }
exec /usr/bin/python3 -B tests/hostile/run.py "$@"
