#!/usr/bin/env bash
# Measures solves on several ranks of this machine and writes docs/ranks.md. About twenty minutes, and 24 GB of memory, during which nothing else should run.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh ranks_bench office_block alvor-import alvor-mpi
python3 bench/ranks/measure.py
