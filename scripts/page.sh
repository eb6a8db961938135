#!/usr/bin/env bash
# page.sh: measures the page in a real browser; writes the figures of docs/page.md and its pictures. Takes some minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvord
scripts/build_page.sh
cd client/web
npx vitest run --config vitest.browser.config.ts test/measure/measure.test.ts
