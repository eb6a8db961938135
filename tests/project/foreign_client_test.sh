#!/usr/bin/env bash
# foreign_client_test.sh BINARIES SOURCE: a client in another language, with nothing but the API and docs/frame-format.md, watches a
# solve at both details, and sees what `alvor probe` reads from the same solution.
set -euo pipefail
. "$(dirname "$0")/start_alvord.sh"
binaries=$1 source=$2 alvord=$1/alvord
work=$(mktemp -d)
server=
trap 'kill $server 2> /dev/null; rm -rf "$work"' EXIT
cd "$work"
start_alvord
mkdir "$work/api"
protoc -I "$source/proto" --python_out "$work/api" "$source"/proto/alvor/v1/*.proto
for detail in exact display; do
  PYTHONPATH=$work/api "$source/examples/python/watch_a_room.py" "$address" "$work/leaves.csv" --detail "$detail" > "$work/watched"
  "$binaries/alvor" watch "$(tail -1 "$work/watched")" --server "$address" -o "$work/room.glb" > /dev/null
  cut -d, -f1-6 "$work/leaves.csv" > "$work/points.csv"
  "$binaries/alvor" probe "$work/room.glb" --points "$work/points.csv" -o "$work/probed.csv"
  # Leaves are constant, the probe interpolates: they differ by less than the displayed error.
  paste -d, "$work/leaves.csv" <(tail -n +2 "$work/probed.csv") | awk -F, -v detail="$detail" '
    { for (k = 0; k < 3; ++k) { d = $(7 + k) - $(16 + k); squares += d * d; sum += $(16 + k); n++ } }
    END { rms = sqrt(squares / n) / (sum / n); printf "%s: %d leaves, differ by %.2f %% of the mean\n", detail, n / 3, 100 * rms
          exit !(n > 300 && rms < 0.02) }'
done
