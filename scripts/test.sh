#!/usr/bin/env bash
# Builds everything and runs all tests, windows included, on a display of their own. Arguments go to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh
# Two tests at a time: the suite is planned for two cores, and tests use threads themselves.
# setup.sh installs a software OpenGL: tests that find none must not pass as skipped.
export PELLUCID_REQUIRE_GL=1
exec xvfb-run -a -s "-noreset -screen 0 1600x1000x24" \
    ctest --preset release --parallel 2 "$@"
