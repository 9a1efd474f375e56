#!/usr/bin/env bash
# Installs a build into a folder, looks whether all is there and valid, runs what was installed, and builds the example
# with it: install_test.sh SOURCE BUILD. What checks files of desktops and shells is used where it is there; what is
# missing is said.
set -euo pipefail
source=$1
build=$2
here=$source/tests/packaging
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/installed
failures=0

fail() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}
# checked TOOL COMMAND…: the command where there is such a tool.
checked() {
    local tool=$1
    shift
    if ! command -v "$tool" >/dev/null; then
        echo "not checked, $tool is missing: $*"
    elif ! "$@" >"$work/said" 2>&1; then
        cat "$work/said" >&2
        fail "$*"
    fi
}
setting() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

cmake --install "$build" --prefix "$prefix" >"$work/log"

# Every file, but for headers.
lib=$(setting CMAKE_INSTALL_LIBDIR)
(cd "$prefix" && find . -type f -o -type l) | sed 's|^\./||' >"$work/all"
grep -v '^include/' "$work/all" | LC_ALL=C sort >"$work/found"
sed "s|^LIB/|$lib/|" "$here/installed.txt" |
    if [ "$(setting PELLUCID_BUILD_GUI)" = ON ]; then sed 's/ gui$//'; else sed '/ gui$/d'; fi |
    if [ "$(setting PELLUCID_MPI)" = ON ]; then sed '1i bin/pellucid-mpi'; else cat; fi |
    LC_ALL=C sort >"$work/wanted"
diff "$work/wanted" "$work/found" || fail "the installed files are not those of installed.txt (<)"
headers=$(grep -c '^include/pellucid/.*\.h$' "$work/all")
[ "$headers" -gt 150 ] || fail "only $headers headers are installed"
! grep '^include/.*\(/gl/\|/mpi/\|[^h]$\)' "$work/all" || fail "headers above need OpenGL or MPI"
! grep -rhoE '#include <(Q[A-Z]|epoxy|OpenImageIO|gdcm|mpi\.h)[^>]*>' "$prefix/include" || fail "headers are not the core's"

# Desktops.
share=$prefix/share
checked xmllint xmllint --noout "$share/mime/packages/pellucid.xml"
checked update-mime-database update-mime-database "$share/mime"
if [ -f "$share/mime/globs2" ]; then
    for pattern in '*.nrrd' '*.mhd' '*.nii.gz' '*.vti' '*.vtk' '*.pvm' '*.vvd' '*.dat' '*.mrml' '*.pellucid.json' '*.dicom' '*.nc4'; do
        grep -qF ":$pattern" "$share/mime/globs2" || fail "no type has the names $pattern"
    done
fi
known=$(grep -oE 'mime-type type="[^"]*"' "$share/mime/packages/pellucid.xml" | cut -d'"' -f2)
types_of() { sed -n 's/^MimeType=//p' "$1" | tr ';' '\n' | sed '/^$/d'; }
for file in "$share/thumbnailers/pellucid.thumbnailer" $([ ! -d "$share/applications" ] || echo "$share/applications/pellucid.desktop"); do
    for type in $known; do
        types_of "$file" | grep -qxF "$type" || fail "$(basename "$file") leaves out $type"
    done
done
if [ -d "$share/applications" ]; then
    checked desktop-file-validate desktop-file-validate "$share/applications/pellucid.desktop"
    checked appstreamcli appstreamcli validate --no-net "$share/metainfo/pellucid.metainfo.xml"
    # The same with a public address for screenshots, which may be that of any folder with the pictures of docs/images.
    cmake -DPELLUCID_SCREENSHOT_URL=https://example.org/images/ -DPROJECT_SOURCE_DIR="$source" -DPROJECT_BINARY_DIR="$work" \
        -DPROJECT_VERSION=1.0.0 -DPELLUCID_ISO_DAY=2024-01-01 -P "$source/cmake/metainfo.cmake"
    checked appstreamcli appstreamcli validate --no-net "$work/pellucid.metainfo.xml"
    pictures=$(sed -n 's|.*>https://example.org/images/\([^/<]*\)</image>.*|\1|p' "$work/pellucid.metainfo.xml")
    [ "$(wc -w <<<"$pictures")" -ge 3 ] || fail "the metainfo has the screenshots $pictures"
    for picture in $pictures; do
        [ -f "$source/docs/images/$picture" ] || fail "docs/images has no $picture"
    done
    for size in 16 24 32 48 64 128 256 512; do
        # Width and height stand at bytes 16 to 23 of a PNG file.
        sizes=$(od -An -tu1 -j16 -N8 "$share/icons/hicolor/${size}x$size/apps/pellucid.png" | tr -s ' \n' ' ')
        [ "$sizes" = " 0 0 $((size / 256)) $((size % 256)) 0 0 $((size / 256)) $((size % 256)) " ] ||
            [ "$sizes" = " 0 0 $((size / 256)) $((size % 256)) 0 0 $((size / 256)) $((size % 256))" ] ||
            fail "the icon of $size pixels has the bytes$sizes"
    done
fi

# Shells.
checked bash bash -n "$share/bash-completion/completions/pellucid-cli"
checked zsh zsh -n "$share/zsh/site-functions/_pellucid-cli"
checked fish fish --no-execute "$share/fish/vendor_completions.d/pellucid-cli.fish"
if command -v fish >/dev/null; then
    offered() { fish -N -c "source $share/fish/vendor_completions.d/pellucid-cli.fish; complete -C '$1'" | cut -f1; }
    [ "$(offered 'pellucid-cli meas')" = measure ] || fail "fish does not complete a command"
    [ "$(offered 'pellucid-cli measure --jaco')" = --jacobian ] || fail "fish does not complete an option"
    [ "$(offered 'pellucid-cli study run x --measure vi')" = visibility ] || fail "fish does not complete a value"
fi

# Manuals.
for manual in "$share"/man/man1/*.gz; do
    gzip -t "$manual" || fail "$manual is not packed"
    checked mandoc mandoc -T utf8 -W error "$manual"
done

# The programs, from there; pictures and TIFF are read and written by what stands beside them.
cli=$prefix/bin/pellucid-cli
cd "$work"
"$cli" --version
"$cli" generate shells --size 24 --out shells.nrrd >/dev/null
"$cli" render shells.nrrd --tf tents:3 --size 64x64 --out picture.png >/dev/null || fail "render"
"$cli" convert shells.nrrd --out shells.tif >/dev/null || fail "convert"
"$cli" info shells.tif | grep -q '24 x 24 x 24' || fail "info of a TIFF file"
"$cli" thumbnail shells.nrrd small --size 128 >/dev/null || fail "thumbnail"
[ "$(head -c 8 small | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "the thumbnail is not a PNG file"
echo "no volume" >notes.txt
status=0
"$cli" thumbnail notes.txt none 2>said || status=$?
[ $status -eq 1 ] && [ ! -e none ] || fail "a thumbnail of a text ends with $status"

# The example, which is a project of its own.
cmake -S "$share/doc/libpellucid-dev/examples/shares" -B example -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_CXX_COMPILER="$(setting CMAKE_CXX_COMPILER)" >log || { cat log && fail "the example is not configured"; }
cmake --build example >log || { cat log && fail "the example is not built"; }
./example/shares shells.nrrd tents:3 >shares
"$cli" measure shells.nrrd --tf tents:3 --json >measured.json
python3 - <<'END' || fail "the example and the command line measure different shares"
import json
rows = [line.split() for line in open("shares")][1:]
features = json.load(open("measured.json"))["features"]
assert len(rows) == len(features) == 3, rows
for (name, visibility, vws, opacity), f in zip(rows, features):
    assert name == f["name"]
    for said, is_ in ((visibility, f["visibility"]), (vws, f["vws"]), (opacity, f["opacity"])):
        assert abs(float(said) - is_) <= 0.5001e-4, (name, said, is_)
END
# Formats of the readers where these are found, and in words where they are not.
cp example/shares "$prefix/bin/shares"
"$prefix/bin/shares" shells.tif tents:3 >shares.tif.txt || fail "the example does not find the readers"
[ "$(wc -l <shares.tif.txt)" -eq 4 ] || fail "the example reads another TIFF file"
rm "$prefix/bin/shares"
status=0
./example/shares absent.nrrd 2>said || status=$?
[ $status -eq 1 ] && grep -q absent.nrrd said || fail "the example does not tell what is wrong with a file"

[ $failures -eq 0 ] || exit 1
echo "all is there"
