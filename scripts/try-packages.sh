#!/usr/bin/env bash
# Installs the packages of build/package in a bare Debian 12, uses them there, and removes them again:
# scripts/try-packages.sh [--keep FOLDER] [FOLDER_OF_DEBS]
#   pellucid-cli alone      needs no Qt, X11 or OpenGL, and works without pellucid-images
#   pellucid-images         EXR and TIFF can be written
#   libpellucid-dev         its example can be built
#   pellucid                the window starts on a virtual display; entry, types of files and icons are valid
#   all of them removed     no file of theirs is left
# --keep: the bare system, its packages and pictures of the window stay in that folder; a second run is quicker. It
# needs root, the network and 3 GB. Everything is mounted in a namespace of its own, which goes with this script.
set -euo pipefail
if [ "${PELLUCID_TRY_ALONE:-}" != 1 ]; then
    cd "$(dirname "$0")/.."
    scripts/setup.sh debootstrap >/dev/null
    PELLUCID_TRY_ALONE=1 exec unshare --mount --propagation private "$PWD/scripts/try-packages.sh" "$@"
fi
keep=
if [ "${1:-}" = --keep ]; then
    keep=${2:?--keep needs a folder}
    shift 2
fi
debs=$(realpath "${1:-build/package}")
work=${keep:-$(mktemp -d)}
mkdir -p "$work"
work=$(realpath "$work")
bare=$work/bare root=$work/root
[ -n "$keep" ] || trap 'umount -R "$root" 2>/dev/null; rm -rf --one-file-system "$work"' EXIT

if [ ! -e "$bare/etc/debian_version" ]; then
    debootstrap --variant=minbase bookworm "$bare" >"$work/debootstrap.log" ||
        { tail -5 "$work/debootstrap.log" >&2 && exit 1; }
    # The packages that the host gets its own from, updates included.
    cp -a /etc/apt/sources.list /etc/apt/sources.list.d "$bare/etc/apt/" 2>/dev/null || true
    cp -a /usr/share/keyrings/debian-archive-keyring.gpg "$bare/usr/share/keyrings/"
fi
rm -rf --one-file-system "$root"
cp -a "$bare" "$root"
mount -t proc proc "$root/proc"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
mkdir "$root/debs"
cp "$debs"/*.deb "$root/debs/"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive HOME=/tmp XDG_RUNTIME_DIR=/tmp "$@"; }
packages() { inside dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' | awk '$1 == "ii" {print $2}' | sort; }
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./tmp -o -path ./debs -o -path ./var \) -prune -o -print) | sort; }
deb() { (cd "$root/debs" && set -- "$1"_*.deb && echo "/debs/$1"); }
install() { # install WORD PACKAGE…
    local before=$1
    shift
    packages >"$work/packages.before"
    inside apt-get install -y --no-install-recommends "$@" >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log" >&2 && exit 1; }
    packages | comm -13 "$work/packages.before" - >"$work/packages.new"
    echo "$before: $(wc -l <"$work/packages.new") packages, $(grep -o 'After this operation, .* of' "$work/apt.log" | cut -d' ' -f4-5)"
}

inside apt-get update -qq
files >"$work/files.before"

install pellucid-cli "$(deb pellucid-cli)"
if grep -iE 'qt|libx11|libxcb|libgl|opengl|mesa' "$work/packages.new"; then
    echo "try-packages: pellucid-cli brings the packages above" >&2
    exit 1
fi
inside sh -ec 'cd /tmp
    pellucid-cli --version
    pellucid-cli generate knee --size 64 --out knee.nrrd
    pellucid-cli render knee.nrrd --out knee.png --size 256x256
    pellucid-cli measure knee.nrrd
    pellucid-cli thumbnail knee.nrrd thumb.png
    pellucid-cli convert knee.nrrd --out knee.tif
    pellucid-cli info knee.tif'
if inside pellucid-cli render /tmp/knee.nrrd --out /tmp/knee.exr 2>"$work/exr.txt"; then
    echo "try-packages: pellucid-cli writes EXR without pellucid-images" >&2
    exit 1
fi
cat "$work/exr.txt"

install pellucid-images "$(deb pellucid-images)"
inside sh -ec 'cd /tmp && pellucid-cli render knee.nrrd --out knee.exr --size 64x64'

install libpellucid-dev "$(deb libpellucid-dev)" cmake make g++
inside sh -ec 'cd /tmp && cmake -S /usr/share/doc/libpellucid-dev/examples/shares -B ex >/dev/null && cmake --build ex >/dev/null && ex/shares knee.tif'

install pellucid "$(deb pellucid)" xvfb xauth fonts-dejavu-core desktop-file-utils appstream shared-mime-info
inside sh -ec 'cd /tmp
    xvfb-run -a -s "-noreset -screen 0 1600x1000x24" pellucid --screenshot window.png --size 1280x800 knee.nrrd
    desktop-file-validate /usr/share/applications/pellucid.desktop
    appstreamcli validate --no-net /usr/share/metainfo/*ellucid*.xml
    grep -q x-nrrd /usr/share/mime/globs2
    [ -s /usr/share/icons/hicolor/48x48/apps/pellucid.png ]'
[ -z "$keep" ] || cp "$root/tmp/window.png" "$root/tmp/knee.png" "$work/"

# What users have written themselves stays; there is nothing of the kind here.
inside sh -ec 'apt-get purge -y pellucid pellucid-cli pellucid-images libpellucid-dev && apt-get autoremove --purge -y' \
    >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log" >&2 && exit 1; }
files | comm -13 "$work/files.before" - | grep -i pellucid >"$work/left.txt" || true
if [ -s "$work/left.txt" ]; then
    echo "try-packages: these files are left:" >&2
    cat "$work/left.txt" >&2
    exit 1
fi
echo "removed without a trace"
