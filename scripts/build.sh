#!/usr/bin/env bash
# Sets up and builds: scripts/build.sh [target…]. Used by run.sh and test.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
if [ ! -f build/release/build.ninja ]; then
    echo "Building for the first time. On two cores this takes 3 to 12 minutes for the command line, 6 to 25 with the window,"
    echo "15 to 35 with the tests."
    cmake --preset release
fi
cmake --build --preset release ${1:+--target "$@"}
