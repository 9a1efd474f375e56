#!/usr/bin/env bash
# What is checked besides the tests: scripts/check.sh [--by SECONDS] [CHECK…], all of them without a name.
#   format    every C++ file is as clang-format leaves it
#   headless  the command line builds alone and needs neither Qt nor OpenGL to start
#   dev       everything builds with assertions and with warnings as errors
# --by: no check begins later than so many seconds after now; those left out are named. Exit status 1 where one fails.
set -euo pipefail
cd "$(dirname "$0")/.."

check_format() {
    local missing=()
    command -v clang-format >/dev/null || missing+=(clang-format)
    scripts/setup.sh "${missing[@]}"
    git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror
}

check_headless() {
    cmake --preset headless >/dev/null
    cmake --build --preset headless --target pellucid-cli
    build/headless/bin/pellucid-cli samples >/dev/null
    if ldd build/headless/bin/pellucid-cli | grep -E 'libQt|libGL\.|libOpenGL'; then
        echo "check: the headless program needs the libraries above" >&2
        return 1
    fi
}

check_dev() {
    cmake --preset dev >/dev/null
    cmake --build --preset dev
}

by=
checks=()
while [ $# -gt 0 ]; do
    case $1 in
        --by)
            by=${2:?--by needs seconds}
            shift
            ;;
        format | headless | dev) checks+=("$1") ;;
        *)
            echo "check: no check is called '$1'; there are format, headless and dev" >&2
            exit 2
            ;;
    esac
    shift
done
[ ${#checks[@]} -gt 0 ] || checks=(format headless dev)

failed=0
start=$SECONDS
for check in "${checks[@]}"; do
    began=$SECONDS
    if [ -n "$by" ] && [ $((began - start)) -ge "$by" ]; then
        echo "check: $check: left out, no time"
        continue
    fi
    # In a shell of its own: after || or in a condition `set -e` would not end a check at its first error.
    set +e
    (
        set -e
        "check_$check"
    )
    status=$?
    set -e
    if [ $status -eq 0 ]; then
        echo "check: $check: passed in $((SECONDS - began)) s"
    else
        echo "check: $check: FAILED after $((SECONDS - began)) s" >&2
        failed=1
    fi
done
exit $failed
