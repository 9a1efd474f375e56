#!/usr/bin/env bash
# Pictures of every panel of the window, in both themes, at 1280x800 and at 100, 200 and 300 %, to be looked at: is
# anything cut off, on top of something else, or too faint to read? Texts that are cut off are printed.
#
#     scripts/panel-pictures.sh FOLDER [BUILD]
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:?name a folder for the pictures}
build=${2:-build/release}
cmake --build "$build" --target window_pictures >/dev/null
mkdir -p "$folder"
for scale in 1 2 3; do
    for theme in dark light; do
        QT_SCALE_FACTOR=$scale xvfb-run -a -s "-noreset -screen 0 $((1280 * scale + 40))x$((800 * scale + 40))x24" \
            "$build/bin/window_pictures" --size 1280x800 --theme "$theme" --sample-size 24 --frames 0:11 \
            --panels "$folder/$theme-$scale" sample:vortex
    done
done
ls "$folder" | wc -l
