#!/usr/bin/env bash
# sanitizers.sh: all tests under AddressSanitizer and UBSan, then those of threads that Debian's gRPC and oneTBB have no part in under
# ThreadSanitizer: these libraries are not built for it, and it takes their every hand-over for a race. Takes half an hour.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
PRESET=asan scripts/build.sh
LSAN_OPTIONS=suppressions=$PWD/tests/sanitizers/lsan.supp:print_suppressions=0 ctest --preset asan
PRESET=tsan scripts/build.sh server_tests solution_test
export TSAN_OPTIONS=suppressions=$PWD/tests/sanitizers/tsan.supp
build/tsan/bin/solution_test --gtest_brief=1
build/tsan/bin/server_tests --gtest_brief=1 --gtest_filter='SolveStore*:KeptSolve*:SolveQuota*:SceneStore*:WatchTest*'
