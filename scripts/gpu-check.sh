#!/usr/bin/env bash
# Builds pellucid-gpu-check, one program to copy to a machine with a GPU (docs/gpu-check.md), and says where it is.
# With arguments it runs it here: scripts/gpu-check.sh --quick
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh pellucid-gpu-check >&2
program=$PWD/build/release/bin/pellucid-gpu-check
if [ $# -gt 0 ]; then
    exec "$program" "$@"
fi
ls -lh "$program"
