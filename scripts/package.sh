#!/usr/bin/env bash
# Makes the packages, into build/package: scripts/package.sh [--cli]
#   pellucid_*.deb, pellucid-cli_*.deb, pellucid-images_*.deb, libpellucid-dev_*.deb and pellucid-*.tar.gz
# --cli: without the window, and without Qt. The maintainer's name and address: PELLUCID_MAINTAINER='Name <address>'.
# A public address of the folder docs/images, for software centres: PELLUCID_SCREENSHOT_URL='https://…'.
set -euo pipefail
cd "$(dirname "$0")/.."
gui=ON
targets=(pellucid pellucid-cli pellucid_core)
if [ "${1:-}" = --cli ]; then
    gui=OFF
    targets=(pellucid-cli pellucid_core)
fi
scripts/setup.sh dpkg-dev file
build=${PELLUCID_PACKAGE_BUILD:-build/package}
# Whoever builds: folders can be read by all, and names of files are what the compiler makes of them, not ccache.
umask 022
export CCACHE_BASEDIR=
# The day of the packages is that of the commit, so that two builds of it are the same.
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}
cmake --preset package -B "$build" -DPELLUCID_BUILD_GUI=$gui \
    ${PELLUCID_MAINTAINER:+"-DPELLUCID_MAINTAINER=$PELLUCID_MAINTAINER"} \
    ${PELLUCID_SCREENSHOT_URL:+"-DPELLUCID_SCREENSHOT_URL=$PELLUCID_SCREENSHOT_URL"} >/dev/null
cmake --build "$build" --target "${targets[@]}"
for program in "$build"/bin/*; do
    if grep -qaF "$PWD/" "$program"; then
        echo "package: $program names the folder that it was built in" >&2
        exit 1
    fi
done
rm -f "$build"/*.deb "$build"/*.tar.gz
(cd "$build" && cpack -G DEB >/dev/null && cpack -G TGZ >/dev/null)
ls -l "$build"/*.deb "$build"/*.tar.gz
