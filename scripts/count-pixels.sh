#!/usr/bin/env bash
# How much of the window the picture, the plot of the transfer function and the bars of the features have, with a series
# and its variables open, at the sizes of screens that people have. Logical pixels; 2560x1440 is at 200 %.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
cmake --build "$build" --target window_pictures >/dev/null
run() { xvfb-run -a -s "-noreset -screen 0 2560x1440x24" "$build/bin/window_pictures" --areas "$@" --sample-size 64 sample:vortex variablesAction featuresAction; }
for size in 1280x800 1366x768 1600x1000; do run --size "$size"; done
QT_SCALE_FACTOR=2 run --size 1280x720
