#!/usr/bin/env bash
# Sets up the machine, builds everything, proves that what mutexes guard is used under them, runs all tests, those in a browser too, feeds
# made-up bytes to what reads foreign ones, attacks the server bare and behind nginx, and pulls plugs in containers where it can.
# Arguments go to CTest.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh
scripts/build_page.sh
scripts/thread_safety.sh
ctest --preset release "$@"
(cd client/web && npm run --silent test && npm run --silent test:browser)
scripts/fuzz.sh 20 1
scripts/hostile.sh
scripts/hostile.sh --front nginx
scripts/test-containers.sh
