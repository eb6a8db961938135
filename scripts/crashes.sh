#!/usr/bin/env bash
# crashes.sh [TIMES]: kills alvord at random moments (200), and looks whether anything that it had acknowledged is lost.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/build.sh server_tests alvord
ALVOR_CRASHES=${1:-200} build/release/bin/server_tests --gtest_filter='KeepingTest.NothingAcknowledgedIsLost*'
