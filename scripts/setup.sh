#!/usr/bin/env bash
# Installs the Debian 12 packages that Pellucid is built, run and tested with. Needs root or sudo for that; does nothing
# when all are there. Packages named as arguments are installed, too; --mpi stands for those of pellucid-mpi.
set -euo pipefail

more=()
for word in "$@"; do
    if [ "$word" = --mpi ]; then more+=(libopenmpi-dev openmpi-bin); else more+=("$word"); fi
done

packages=(
    # the build
    g++ cmake ninja-build ccache pkg-config git ca-certificates
    # volume files, images, threads, maths, JSON, XML, command line
    zlib1g-dev libbz2-dev liblz4-dev liblzma-dev libdeflate-dev libzstd-dev libblosc-dev libgdcm-dev libtiff-dev libhdf5-dev libnetcdf-dev
    libopenimageio-dev libpango1.0-dev libtbb-dev libglm-dev libeigen3-dev nlohmann-json3-dev libpugixml-dev libcli11-dev
    # OpenGL, on a GPU or in software, with and without a display
    libepoxy-dev libgl-dev libegl-dev libopengl-dev libegl1 libgl1-mesa-dri libegl-mesa0 libosmesa6
    # figures for print: what their letters are set in
    fonts-liberation
    # the window
    qt6-base-dev qt6-svg-dev libqt6opengl6-dev libqt6openglwidgets6
    # the tests: Catch2, a display without a screen, a font for its windows, scripts, films and what plays them back
    catch2 xvfb xauth fonts-dejavu-core python3 python3-numpy ffmpeg
    "${more[@]}"
)

if [ "$(dpkg-query -W -f '${db:Status-Status}\n' "${packages[@]}" 2>/dev/null | grep -c '^installed$')" -eq "${#packages[@]}" ]; then
    exit 0
fi
missing=()
for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
done

echo "setup: installing ${#missing[@]} Debian packages: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "setup: not root and no sudo: install these packages by hand, then run this again" >&2
        exit 1
    }
    as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
