#!/usr/bin/env bash
# make_room.sh [FOLDER [PICTURE.png]]: makes the exported rooms anew in FOLDER (files/ beside this script) and checks them. Installs
# Debian's Blender if there is none; neither the build nor the tests need it.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-$here/files}

if ! command -v blender > /dev/null; then
  apt-get update -qq
  apt-get install -y -qq --no-install-recommends blender python3-numpy
fi
blender -b --factory-startup --python-exit-code 1 --python "$here/make_room.py" -- "$out" "${@:2}"
python3 "$here/check_files.py" "$out"
