#!/usr/bin/env bash
# Measures every method of computing form factors against exact values: docs/form-factors.md.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh form_factor_table
build/release/bin/form_factor_table tests/truth/form_factors.csv > docs/form-factors.md
echo "wrote docs/form-factors.md"
