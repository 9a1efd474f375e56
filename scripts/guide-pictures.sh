#!/usr/bin/env bash
# Makes the pictures of docs/images anew, so that they show the window and the command line as they are:
#
#     scripts/guide-pictures.sh [--build DIR] [--data DIR] [--out DIR] [NAME…]
#
# NAMEs are those of docs/images without ".png"; without one all are made. Pictures of the window are lists of steps,
# which tests/tools/window_pictures.cpp takes; the others are drawn by pellucid-cli. Nearly all are of built-in samples
# and of what tests/tools/guide_data.cpp makes up. Those of real volumes need --data, which is ../shared/data/real where
# that is there; what is left out, for want of that or of a browser, is told. Look at every picture, and at the text
# around it: it must say what the picture shows.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/release data=../shared/data/real out=docs/images
while [[ ${1:-} == --* ]]; do
    case $1 in
    --build) build=$2 ;;
    --data) data=$2 ;;
    --out) out=$2 ;;
    *) echo "guide-pictures: no such option: $1" >&2; exit 2 ;;
    esac
    shift 2
done
wanted=("$@")
cli=$build/bin/pellucid-cli
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$out"
cmake --build "$build" --target window_pictures guide_data pellucid-cli >/dev/null
for program in convert montage mogrify pdftoppm; do
    command -v "$program" >/dev/null || { echo "guide-pictures: install imagemagick and poppler-utils" >&2; exit 1; }
done

# wants NAME [FILE…]: whether it is asked for, and the FILEs of real data are there.
wants() {
    if ((${#wanted[@]})) && [[ ! " ${wanted[*]} " == *" $1 "* ]]; then return 1; fi
    local file
    for file in "${@:2}"; do
        if [[ ! -e $data/$file ]]; then
            echo "$1: left out, there is no $data/$file"
            return 1
        fi
    done
    echo "$1"
}

# window NAME ARGUMENT…
window() { xvfb-run -a -s "-noreset -screen 0 1600x1100x24" "$build/bin/window_pictures" --out "$out/$1.png" "${@:2}"; }
picture() { if wants "$1"; then window "$@"; fi; }
render() { "$cli" render "$@" --no-metadata >/dev/null; }
# sheet NAME COLUMNS CELL FILE…: side by side, with fine lines between; of 256 colours, which keeps it small.
sheet() {
    montage "${@:4}" -tile "$2x" -geometry "$3+1+1" -background '#303030' "$scratch/sheet.png"
    convert "$scratch/sheet.png" -dither None -colors 256 "PNG8:$out/$1.png"
}
made_up() { [[ -d $scratch/data ]] || "$build/bin/guide_data" "$scratch/data"; }

# ---- the window, on samples

shells=(--tf auto sample:shells)
knee=(--sample-size 160 sample:knee)

picture window_opened "${shells[@]}"
picture tour --sample-size 64 sample:shells tourAction click:tourNext
picture window_optimized "${shells[@]}" targets:1,2,3 optimizeAction
picture convergence --sample-size 24 --tf tents:3 sample:shells targets:1,3,6 "set:methodCombo=Fixed step" \
    set:mostMovesSpin=20 optimizeAction convergenceAction click:showStart \
    "set:methodCombo=Parallel line search" optimizeAction
picture window_influence "${knee[@]}" influenceAction
picture targets "${knee[@]}" targetsDiagonal key:targetBars=L liveTargetsAction
picture window_clip "${shells[@]}" clipAction addPlaneAction view:95,30,1.66
picture window_display "${shells[@]}" set:clipXHi=55 displayAction
picture probe "${knee[@]}" at:volumeView=0.52,0.52
picture best_view "${knee[@]}" viewsAction
picture slices "${knee[@]}" layoutFourAction
picture fields "${shells[@]}" set:clipYLo=50 fieldsAction "set:fieldKindCombo=Visibility-weighted saliency"
picture picture_saliency "${knee[@]}" pictureSaliencyAction followPictureAction \
    "set:pictureSaliencyMap=The whole picture"
picture compare "${knee[@]}" targetsInsideOut optimizeAction compareRunAction compareSideBySideAction compareAction
picture tf_editor "${shells[@]}" jointHistogram select:1 wheel:tfCanvas=0.05,0.5,1 drag:tfCanvas=0.39,0.25,0.55,0.8 \
    over:tfCanvas=0.57,0.4 of:tfDock
picture color_vision "${knee[@]}" visionDeuteranopiaAction
picture refiner --size 1280x860 sample:knee set:clipYLo=50 "set:refineMethodCombo=Exact" refinementAction \
    rectangleAction drag:volumeView=0.474,0.39,0.526,0.435
picture keyframes "${knee[@]}" keyframesAction addKeyframeAction view:60,10,1.2 set:clipXHi=50 addKeyframeAction \
    view:120,25,1.6 addKeyframeAction \
    over:keyStrip=0.5,0.9 over:volumeView=0.9,0.1 over:keyStrip=0.5,0.9 over:volumeView=0.9,0.1 # its pictures come
picture parameter_space --size 1280x900 --sample-size 64 --tf tents:3 sample:shells targets:1,3,6 \
    "set:methodCombo=Parallel line search" optimizeAction undoAction "set:methodCombo=Fixed step" optimizeAction \
    spaceAction click:spaceCompute
series=(--size 1280x860 --sample-size 64 --frames 0:98:2 sample:vortex optimizeAction adaptOptimizeAction frame:20)
picture player "${series[@]}"
picture curves_over_time "${series[@]}" set:coherence=0 playerAction temporalAction height:temporal=260 \
    click:temporalMeasure

if wants raw_dialog; then
    made_up
    window raw_dialog --sample-size 16 sample:shells "dialog:open:$scratch/data/scan.raw"
fi
if wants series_dialog; then
    made_up
    window series_dialog --sample-size 16 sample:shells "dialog:open:$scratch/data/study"
fi
if wants overlay nifti/ch2.nii.gz; then
    made_up
    window overlay --size 1400x860 "$data/nifti/ch2.nii.gz" "overlay:$scratch/data/tmap.nrrd" set:overlayThreshold=3.1 \
        set:overlayOpacity=0.3 set:clipZHi=55 overlayAction layoutFourAction crosshair:44,-14,28 view:40,50,1.6
fi

# ---- several variables: the pictures carry their sessions, the last of which the window opens

variables() { # SAMPLE OPTION…
    "$cli" render "sample:$1" "${@:2}" --shading --size 640x480 --out "$scratch/$1.png" >/dev/null
    convert "$scratch/$1.png" -strip "$out/variables_$1.png"
}
vortex=(--tf auto --frame 40 --view 30,15,1.2 --hsb saturation=volatility:x:10,brightness=gradient:x,b=1)
smoke=(--tf auto --frame 90 --view 30,5,1.4 --hsb saturation=volatility:x:10,brightness=gradient:x,a=10,b=1.5)
hurricane=(--tf auto --frame 30 --view 20,40,1.5 --variable precipitation=sample:hurricane/precipitation
    --hsb saturation=volatility:x:10,brightness=precipitation,b=8 --ground sample:hurricane/ground)
if wants variables_vortex; then variables vortex "${vortex[@]}"; fi
if wants variables_smoke; then variables smoke "${smoke[@]}"; fi
if wants variables_hurricane; then variables hurricane "${hurricane[@]}"; fi
if wants variables; then
    "$cli" render sample:hurricane "${hurricane[@]}" --shading --size 64x48 --out "$scratch/session.png" >/dev/null
    window variables --size 1280x860 "$scratch/session.png" variablesAction
fi

# ---- the command line

if wants knee_before_after; then
    render sample:knee --tf tents:3 --view 25,15,1.2 --size 420x560 --out "$scratch/before.png"
    render sample:knee --shading --view 25,15,1.2 --size 420x560 --out "$scratch/after.png"
    convert "$scratch/before.png" "$scratch/after.png" +append "$out/knee_before_after.png"
fi
if wants figure; then
    "$cli" figure sample:knee --view front,1.1 --shading --background 1,1,1 --parts scale,cube,legend,shares,targets \
        --out "$scratch/figure.pdf" >/dev/null
    pdftoppm -png -singlefile -r 200 "$scratch/figure.pdf" "$out/figure"
fi
if wants share; then
    browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
    if [[ -z $browser ]]; then
        echo "share: left out, there is no Chromium"
    else
        "$cli" share sample:knee --sample-size 128 --view 25,15,1.2 --shading --title Knee --out "$scratch/page.html" \
            >/dev/null
        PYTHONPATH=tests/tools python3 - "$browser" "$scratch" "$out/share.png" <<'PYTHON'
import sys
from drive_page import Browser
browser, scratch, out = sys.argv[1:]
with Browser(browser, scratch + "/profile", width=900, height=740) as page:
    page.open(scratch + "/page.html")
    page.value("window.pellucid.settled()")
    page.screenshot(out)
PYTHON
    fi
fi

# ---- real volumes

if wants first_sight tooth/tooth.mhd; then
    /usr/bin/python3 benchmarks/first_sight.py --cli "$cli" --data "$data" --report --sheet "$scratch/first_sight.png" \
        >/dev/null
    convert "$scratch/first_sight.png" -dither None -colors 256 "PNG8:$out/first_sight.png"
fi
if wants real_volumes cranium_ct/cranium_ct.nrrd nifti/ch2.nii.gz walnut/walnut.mhd tooth/tooth.mhd; then
    pictures=()
    for file in cranium_ct/cranium_ct.nrrd nifti/ch2.nii.gz walnut/walnut.mhd tooth/tooth.mhd; do
        pictures+=("$scratch/real$(basename "$file").png")
        render "$data/$file" --annotate all --shading --size 600x480 --out "${pictures[-1]}"
    done
    sheet real_volumes 2 600x480 "${pictures[@]}"
fi

# refined VOLUME TF CUT… --region REGION: a row of the picture of refinements.
cells=()
cell() { # RENDER ARGUMENT…
    cells+=("$scratch/cell$(printf %03d "${#cells[@]}").png")
    render "$@" --size 300x300 --out "${cells[-1]}"
}
refined() {
    local volume=$1 tf=$2 region=$3 at
    local cut=("${@:4}")
    cell "$volume" --tf "$tf"
    "$cli" refine "$volume" --tf "$tf" --out-tf "$scratch/all.tf.json" >/dev/null
    cell "$volume" --tf "$scratch/all.tf.json"
    for hue in 90 150 210; do
        "$cli" refine "$volume" --tf "$tf" --hue "$hue" --out-tf "$scratch/hue.tf.json" >/dev/null
        cell "$volume" --tf "$scratch/hue.tf.json"
    done
    cell "$volume" --tf "$tf" "${cut[@]}"
    at=(${region//,/ })
    mogrify -fill none -stroke white -strokewidth 2 -draw "rectangle ${at[0]},${at[1]} ${at[2]},${at[3]}" "${cells[-1]}"
    "$cli" refine "$volume" --tf "$tf" "${cut[@]}" --size 300x300 --region "$region" \
        --out-tf "$scratch/region.tf.json" >/dev/null
    cell "$volume" --tf "$scratch/region.tf.json" "${cut[@]}"
    cell "$volume" --tf "$scratch/region.tf.json"
}
if wants refinement tooth/tooth.mhd cranium_ct/cranium_ct.nrrd; then
    cells=()
    for tf in tents:6 ramp:6; do
        refined "$data/tooth/tooth.mhd" "$tf" 105,190,115,215 --view 0,0 --clip y:0.5:1
    done
    for tf in tents:6 ramp:6; do
        refined "$data/cranium_ct/cranium_ct.nrrd" "$tf" 96,150,101,190 --view superior --clip z:0:0.6
    done
    mogrify -gravity center -crop 236x236+0+0 +repage "${cells[@]}"
    sheet refinement 8 160x160 "${cells[@]}"
fi
if wants refinement_proposal tooth/tooth.mhd cranium_ct/cranium_ct.nrrd; then
    cells=()
    for volume in tooth/tooth.mhd cranium_ct/cranium_ct.nrrd; do
        for method in greedy exact; do
            cell "$data/$volume" --shading --view 60,20,1.2
            for choice in "" "--intensity 0.4" "--intensity 0.6" "--intensity 0.9"; do
                "$cli" refine "$data/$volume" --method "$method" $choice --out-tf "$scratch/refined.tf.json" >/dev/null
                cell "$data/$volume" --tf "$scratch/refined.tf.json" --shading --view 60,20,1.2
            done
        done
    done
    sheet refinement_proposal 5 200x200 "${cells[@]}"
fi
