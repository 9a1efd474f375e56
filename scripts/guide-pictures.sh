#!/usr/bin/env bash
# Makes pictures of the window for the guide anew, from built-in samples alone, so that they show the window as it is:
#
#     scripts/guide-pictures.sh [--build DIR] [NAME…]
#
# NAMEs are those of docs/images without ".png"; without one all that are listed below. What each picture shows is the
# list of steps that tests/tools/window_pictures.cpp takes. Pictures that are not listed are made by hand.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/release
if [[ ${1:-} == --build ]]; then
    build=$2
    shift 2
fi
wanted=("$@")
cmake --build "$build" --target window_pictures >/dev/null

# picture NAME ARGUMENT…
picture() {
    local name=$1
    shift
    if ((${#wanted[@]})) && [[ ! " ${wanted[*]} " == *" $name "* ]]; then return; fi
    echo "$name"
    xvfb-run -a -s "-screen 0 1600x1000x24" "$build/bin/window_pictures" --out "docs/images/$name.png" "$@"
}

picture window_opened sample:shells
picture window_display sample:shells set:clipXHi=55 displayAction
picture slices --sample-size 160 sample:knee layoutFourAction
picture tour --sample-size 64 sample:shells tourAction click:tourNext
picture color_vision --sample-size 96 sample:knee visionDeuteranopiaAction
