#!/usr/bin/env bash
# Builds the packages twice, in two folders of different names, and compares their bytes:
# scripts/reproducible.sh [--cli] [FOLDER]   (a new one below /tmp; it needs 3 GB, and twice the time of a build)
# --cli: without the window.
set -euo pipefail
cd "$(dirname "$0")/.."
only=()
if [ "${1:-}" = --cli ]; then
    only=(--cli)
    shift
fi
work=${1:-$(mktemp -d)}
commit=$(git rev-parse HEAD) # of both, whatever is committed meanwhile
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct "$commit")}
for name in first second-with-a-longer-name; do
    mkdir -p "$work/$name"
    git archive "$commit" | tar -x -C "$work/$name"
    (cd "$work/$name" && umask $([ $name = first ] && echo 022 || echo 077) &&
        PELLUCID_PACKAGE_BUILD="$work/$name/out" scripts/package.sh "${only[@]}")
done
status=0
for file in "$work"/first/out/*.deb "$work"/first/out/*.tar.gz; do
    if cmp "$file" "$work/second-with-a-longer-name/out/$(basename "$file")"; then
        echo "same: $(basename "$file")"
    else
        status=1
    fi
done
exit $status
