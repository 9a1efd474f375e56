#!/usr/bin/env bash
# Sets up and builds: scripts/build.sh [target…]. Used by run.sh and test.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
if [ ! -f build/release/build.ninja ]; then
    cmake --preset release
fi
cmake --build --preset release ${1:+--target "$@"}
