#!/usr/bin/env bash
# build_page.sh: builds the page for browsers beside the programs, in build/release/bin/web. Quiet unless something is wrong.
set -euo pipefail
cd "$(dirname "$0")/../client/web"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() { "$@" > "$log" 2>&1 || { cat "$log" >&2; exit 1; }; }

out=$PWD/../../build/release/bin/web
# Packages are those of the lock file; they are fetched again only when it changes.
if ! cmp -s package-lock.json node_modules/.installed-lock; then
  echo "Fetching the page's packages"
  quietly npm ci --no-audit --no-fund
  cp package-lock.json node_modules/.installed-lock
fi
mkdir -p src/gen
quietly npm run api
quietly npm run check
quietly npx vite build --outDir "$out"
mkdir -p "$out/scenes"
cp ../../scenes/*.obj ../../scenes/*.mtl "$out/scenes"
find "$out" -type f ! -name '*.gz' -exec gzip -9 -n -k -f {} +
