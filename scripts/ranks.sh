#!/usr/bin/env bash
# Measures solves on several ranks and writes docs/ranks.md. Nothing else should run meanwhile. About five minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
