#!/usr/bin/env bash
# Builds the plugin for ParaView and checks it: by pvbatch on 1, 2 and 4 processes, and by a client at pvserver, against
# pellucid-cli. For a machine, or a container, with Debian's paraview-dev, which takes the place of python3-vtk9:
#
#     debootstrap bookworm /srv/paraview http://deb.debian.org/debian
#     mount --bind . /srv/paraview/mnt && chroot /srv/paraview /mnt/scripts/paraview-check.sh
#
# BUILD: where to build (default build/paraview); OUT: where pictures and figures go (default out/paraview).
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build/paraview} out=${OUT:-out/paraview}
scripts/setup.sh --mpi paraview paraview-dev python3-paraview libdouble-conversion-dev liblz4-dev liblzma-dev \
    libutfcpp-dev libexpat1-dev libglew-dev libhdf5-dev libnetcdf-dev libogg-dev libtheora-dev libxml2-dev \
    libjsoncpp-dev libprotobuf-dev protobuf-compiler libpng-dev libjpeg-dev libtiff-dev libfreetype-dev libcgns-dev \
    libgl2ps-dev libproj-dev python3-dev
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPELLUCID_BUILD_GUI=OFF -DPELLUCID_BUILD_TESTS=OFF \
    -DPELLUCID_PARAVIEW=ON
cmake --build "$build" --target Pellucid pellucid-cli
plugin=$(find "$(realpath "$build")" -name Pellucid.so)
mkdir -p "$out"
exec python3 app/paraview/check.py --plugin "$plugin" --cli "${CLI:-$build/bin/pellucid-cli}" --out "$out"
