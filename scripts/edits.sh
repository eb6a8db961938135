#!/usr/bin/env bash
# Measures edits of the finished furnished room and writes the figures and pictures of docs/edits.md. About four minutes, during which nothing else should run.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh edits office_block alvor-import alvord
scripts/build_page.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
figures=$work/figures
build/release/bin/office_block --faces 50000 -o "$work/office.obj"
build/release/bin/edits --scene scenes/furnished_room.obj --window docs/lights/window.obj --office "$work/office.obj" --tolerance 0.02 > "$figures"
cat "$figures"
(cd client/web && ALVOR_FIGURES=$figures npx vitest run --config vitest.browser.config.ts test/measure/edits.test.ts)
python3 - "$figures" <<'PYTHON'
import pathlib, sys
page = pathlib.Path("docs/edits.md")
head = page.read_text().split("## Figures\n")[0]
page.write_text(head + "## Figures\n\nWritten by `scripts/edits.sh`: the furnished room at 2 %, on two cores, server and watcher in one process. Times are from the call of\n"
                "`EditSolve` to the end of the watcher's first frame with a state that heeds it, and with one whose estimated error is within the\ntolerance again. "
                "A light that is switched off needs rays because shadows of the other are seen then. Below the first table: a slider that dims\none of the lamps, a desk that is moved in an office of 50 000 faces and 600 lamps at 10 %, and the sun that goes on before the window of a bare room\n(docs/lights/window.obj), under a clear sky, at 10 %.\n\n"
                + pathlib.Path(sys.argv[1]).read_text())
PYTHON
