#!/usr/bin/env bash
# Measures edits of the finished furnished room and writes the figures of docs/edits.md. About two minutes, during which nothing else should run.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh edits alvor-import
figures=$(mktemp)
trap 'rm -f "$figures"' EXIT
build/release/bin/edits --scene scenes/furnished_room.obj --tolerance 0.02 > "$figures"
cat "$figures"
python3 - "$figures" <<'PYTHON'
import pathlib, sys
page = pathlib.Path("docs/edits.md")
head = page.read_text().split("## Figures\n")[0]
page.write_text(head + "## Figures\n\nWritten by `scripts/edits.sh`. Times are from the call of `EditSolve` to the watcher's frame, in one process.\n\n"
                + pathlib.Path(sys.argv[1]).read_text())
PYTHON
