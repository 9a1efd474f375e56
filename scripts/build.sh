#!/usr/bin/env bash
# Sets up and builds: scripts/build.sh [target…]. Used by run.sh and test.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
if [ ! -f build/release/build.ninja ]; then
    echo "Building for the first time: three minutes for the command line, six with the window, fifteen with the tests,"
    echo "on two cores."
    cmake --preset release
fi
cmake --build --preset release ${1:+--target "$@"}
