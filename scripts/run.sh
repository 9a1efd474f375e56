#!/usr/bin/env bash
# Builds Pellucid and starts the window, on a built-in volume or on the files given. Without a display it does the
# same job headless: measure, optimize, and pictures before and after, into out/.
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/.."
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    scripts/build.sh pellucid pellucid-cli
    bin=$PWD/build/release/bin
    cd "$here"
    exec "$bin/pellucid" "$@"
fi

if [ $# -gt 1 ] || [[ ${1:-} == -* ]]; then
    echo "run.sh: without a display it takes one volume; pellucid-cli has the options" >&2
    exit 2
fi
scripts/build.sh pellucid-cli
cli=$PWD/build/release/bin/pellucid-cli
volume=${1:-sample:shells}
case $volume in
    sample:* | /*) ;;
    *) volume=$here/$volume ;;
esac
out=$PWD/out
mkdir -p "$out"
echo "No display: the same job without a window, on $volume"
"$cli" render "$volume" --out "$out/before.png" --size 640x640
{
    echo "# Pellucid on ${volume##*/}"
    echo
    "$cli" info "$volume"
    echo
    echo "## Before: what each feature shows"
    "$cli" measure "$volume"
    echo
    echo "## Optimized: each feature more salient than the one before it"
} >"$out/report.txt"
features=$("$cli" measure "$volume" --json | grep -o '"vws":' | wc -l)
target=$(seq -s, 1 "$features") # the innermost feature is to be seen most
"$cli" optimize "$volume" --target "$target" --out-tf "$out/optimized.tf.json" --out-camera "$out/camera.json" \
    >>"$out/report.txt"
# From where the others look: a transfer function that is named is shown from the same place for all volumes.
optimized=(--tf "$out/optimized.tf.json" --camera "$out/camera.json")
"$cli" render "$volume" "${optimized[@]}" --out "$out/after.png" --size 640x640
{
    echo
    echo "## After"
    "$cli" measure "$volume" "${optimized[@]}"
} >>"$out/report.txt"
echo "Written: $out/before.png, $out/after.png, $out/optimized.tf.json, $out/camera.json, $out/report.txt"
