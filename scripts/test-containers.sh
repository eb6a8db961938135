#!/usr/bin/env bash
# test-containers.sh [--keep] [--write] [PYTEST ARGUMENTS...]: builds the images of docker/ and runs tests/integration in containers, on podman.
# Says why, and does nothing, where podman cannot work. Leaves build/containers/table.md; --write puts it into docs/integration.md. Removes its
# containers, networks and images on every exit; --keep keeps images for the next time.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/integration/podman.sh

keep=0 write=0
while true; do
  case ${1:-} in
    --keep) keep=1 ;;
    --write) write=1 ;;
    *) break ;;
  esac
  shift
done
skip() { echo "container tests: skipped: $*"; exit 0; }
[ "$(id -u)" = 0 ] || skip "needs root"
scripts/setup.sh containers

work=$PWD/build/containers
mkdir -p "$work"
configure_podman
why=$(podman info 2>&1 > /dev/null) || skip "podman does not work here: ${why##*$'\n'}"
note_network
tests=
clean_up() {
  [ -z "$tests" ] || kill "$tests" 2> /dev/null || true
  remove_containers $keep || true
  restore_network
}
trap clean_up EXIT
trap 'exit 1' INT TERM HUP
remove_containers 1 # of a run that was killed

echo "Building the images"
why=$(provide_base_image 2>&1) || skip "no base image: ${why##*$'\n'}"
first=$(podman run --rm --network host "$base_image" true 2>&1) || skip "podman cannot run a container here: ${first##*$'\n'}"
build_image server
build_image server ranks
build_image client
build_image front

echo "Testing in containers"
/usr/bin/python3 -m pytest -q -p no:cacheprovider tests/integration --table "$work/table.md" "$@" & tests=$!
wait $tests
tests=
if [ $write = 1 ]; then
  sed -i -e '/^<!-- table -->/,/^<!-- end -->/{//!d}' -e "/^<!-- table -->/r $work/table.md" docs/integration.md
fi
