#!/usr/bin/env bash
# demo.sh [--web [HOST:PORT]]: sets up the machine, builds Alvor and solves a room. Leaves the solution, pictures and plots in out/. With
# --web it then serves the page (127.0.0.1:8080) until it is interrupted.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh alvor alvord
scripts/build_page.sh

alvor=build/release/bin/alvor
mkdir -p out
echo "Solving scenes/cornell_box.obj"
"$alvor" solve scenes/cornell_box.obj -o out/cornell_box.glb --report out/report.csv --frames out/frames --no-ambient
"$alvor" render out/cornell_box.glb -o out/cornell_box.png
"$alvor" render out/cornell_box.glb --wireframe -o out/mesh.png
gnuplot -c scripts/error_vs_time.gnuplot out/report.csv out/error_vs_time.png

cat <<EOF

out/cornell_box.glb     the solution, for any glTF viewer
out/cornell_box.png     the room
out/frames/             the room while it brightens, $(ls out/frames/frame_*.png | wc -l) pictures
out/mesh.png            the final mesh over the shading
out/report.csv          error, rays and leaves against run time
out/error_vs_time.png   the same as a plot
EOF
web=${2:-127.0.0.1:8080}
if [ "${1:-}" = --web ]; then
  echo
  echo "Open http://$web/ (Ctrl-C ends it)"
  exec build/release/bin/alvord --listen 127.0.0.1:0 --web "$web" --log-level warning
fi
echo
echo "To watch a room in a browser: build/release/bin/alvord --web $web, and open http://$web/"
