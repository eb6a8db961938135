#!/usr/bin/env bash
# Sets up the machine, builds everything, proves that what mutexes guard is used under them, runs all tests, those in a browser too, feeds
# made-up bytes to what reads foreign ones, attacks the server bare and behind nginx, and pulls plugs in containers where it can.
# The containers mostly wait, so they run beside what comes after the page's tests, but not beside the attacks, which measure how long bystanders
# wait. Arguments go to CTest.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { echo "[$((SECONDS / 60)) min] $*"; }

scripts/setup.sh
[ "$(id -u)" != 0 ] || scripts/setup.sh containers # before two of the steps want to install something at once
step "building"
scripts/build.sh
scripts/build_page.sh
step "testing"
ctest --preset release "$@"
step "testing the page"
(cd client/web && npm run --silent test && npm run --silent test:browser)

said=$(mktemp)
containers=
clean_up() {
  if [ -n "$containers" ]; then kill "$containers" 2> /dev/null && wait "$containers" || true; fi
  rm -f "$said"
}
trap clean_up EXIT
trap 'exit 1' INT TERM HUP
scripts/test-containers.sh > "$said" 2>&1 & containers=$!

step "checking mutexes"
scripts/thread_safety.sh
step "feeding made-up bytes"
scripts/fuzz.sh 20 1
step "waiting for the containers"
wait "$containers" || { containers=; cat "$said"; exit 1; }
containers=
cat "$said"
step "attacking"
scripts/hostile.sh
scripts/hostile.sh --front nginx
step "done"
