#!/usr/bin/env bash
# What is checked besides the tests: scripts/check.sh [--by SECONDS] [--end SECONDS] [CHECK…], all without a name.
#   format    every C++ file is as clang-format leaves it
#   mpi       pellucid-mpi builds, and its ranks measure what one process measures
#   packages  the packages build, and lintian finds no error in them (scripts/try-packages.sh installs them)
#   headless  the command line builds alone and needs neither Qt nor OpenGL to start
#   headers   damaged headers of volume files, 2 000 of each format, are read or refused in words
#   foreign   damaged files of the formats that libraries read, 500 of each, are read or refused in words
#   dev       everything builds with assertions and with warnings as errors
#   asan      no fault of addresses or undefined behaviour in the tests of files, fields, sessions and commands, nor in what
#             damaged headers make of the readers
#   asan-mpi  nor in blocks on ranks, nor in pellucid-mpi, its ranks killed and its files broken
#   mutants   nor in what damaged files of all formats make of the readers: 2 000 of each, many in one process
#   tsan      no race in the tests that use threads
#   fuzz      no input that clang's libFuzzer makes up in 60 s for each of our parsers is more to them than an error
#   zink      the tests of OpenGL with another driver: Mesa's zink over its software Vulkan
#   tidy      clang-tidy has nothing to say of files that differ from PELLUCID_BASE (the commit before this one)
# No check begins later than --by seconds after now, and one that still runs after --end seconds is stopped; neither is a
# failure, and both are named. Exit status 1 where a check fails.
set -euo pipefail
cd "$(dirname "$0")/.."
all=(format mpi packages headless headers foreign dev asan asan-mpi mutants tsan fuzz zink tidy)

# Installs the packages of the commands that are missing: need COMMAND PACKAGE …
need() {
    local missing=()
    while [ $# -gt 0 ]; do
        command -v "$1" >/dev/null || missing+=("$2")
        shift 2
    done
    scripts/setup.sh "${missing[@]}"
}

on_display() { xvfb-run -a -s "-noreset -screen 0 1600x1000x24" "$@"; }

check_format() {
    need clang-format clang-format
    git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror
}

check_mpi() {
    scripts/setup.sh --mpi
    cmake --preset release -DPELLUCID_MPI=ON >/dev/null
    cmake --build --preset release --target pellucid-cli pellucid-mpi test_mpi
    ctest --preset release -L '^mpi$'
}

check_packages() {
    scripts/setup.sh lintian
    scripts/package.sh
    lintian --fail-on error build/package/*.deb
}

check_headless() {
    need
    cmake --preset headless >/dev/null
    cmake --build --preset headless --target pellucid-cli
    build/headless/bin/pellucid-cli samples >/dev/null
    if ldd build/headless/bin/pellucid-cli | grep -E 'libQt|libGL\.|libOpenGL'; then
        echo "check: the headless program needs the libraries above" >&2
        return 1
    fi
}

check_headers() {
    need
    scripts/build.sh pellucid-cli
    python3 tests/tools/mutate_headers.py build/release/bin/pellucid-cli --count 2000 --jobs "$(nproc)"
}

check_foreign() {
    scripts/setup.sh python3-pydicom python3-tifffile python3-h5py python3-netcdf4 python3-zarr
    scripts/build.sh pellucid-cli pellucid-reader
    /usr/bin/python3 tests/tools/mutate_foreign.py build/release/bin/pellucid-cli --count 500 --jobs "$(nproc)"
}

check_dev() {
    need
    cmake --preset dev >/dev/null
    cmake --build --preset dev
}

check_asan() {
    need
    cmake --preset dev-asan >/dev/null
    cmake --build --preset dev-asan --target \
        pellucid-cli test_base test_volume test_tf test_saliency test_session test_cli
    export UBSAN_OPTIONS=print_stacktrace=1
    local status=0
    ctest --preset dev-asan --parallel 2 -L '^(base|volume|tf|saliency)$' || status=1
    # Without the search for leaks: the drivers of OpenGL keep what they have until the program ends.
    ASAN_OPTIONS=detect_leaks=0 ctest --preset dev-asan --parallel 2 -L '^(session|cli|tools)$' || status=1
    return $status
}

check_asan-mpi() {
    scripts/setup.sh --mpi
    cmake --preset dev-asan -DPELLUCID_MPI=ON >/dev/null
    cmake --build --preset dev-asan --target pellucid-cli pellucid-mpi test_ranks test_mpi
    # GCC 12's runtime takes some blocks of thread-local variables for what glibc made before 2.25, and its search for leaks
    # then ends with signal 11.
    export ASAN_OPTIONS=intercept_tls_get_addr=0
    export UBSAN_OPTIONS=print_stacktrace=1 LSAN_OPTIONS="suppressions=$PWD/scripts/lsan-mpi.supp:print_suppressions=0"
    ctest --preset dev-asan -L '^(ranks|mpi)$'
}

check_mutants() {
    scripts/setup.sh python3-pydicom python3-tifffile python3-h5py python3-netcdf4 python3-zarr
    cmake --preset dev-asan >/dev/null
    cmake --build --preset dev-asan --target open_files open_foreign_{dicom,tiff,images,arrays}
    local status=0
    python3 tests/tools/mutate_headers.py build/dev-asan/bin/open_files --count 2000 --jobs "$(nproc)" || status=1
    /usr/bin/python3 tests/tools/mutate_foreign.py build/dev-asan/bin/open_foreign --count 2000 --jobs "$(nproc)" ||
        status=1
    return $status
}

check_tsan() {
    need
    cmake --preset dev-tsan >/dev/null
    cmake --build --preset dev-tsan --target test_base test_parallel_threads test_volume test_session test_gui
    export TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp:halt_on_error=1:second_deadlock_stack=1"
    local status=0
    # The sanitizer needs more addresses than a limit on them leaves.
    on_display ctest --preset dev-tsan --parallel 2 -L '^(base|parallel_threads)$' -E 'address space' || status=1
    on_display ctest --preset dev-tsan --parallel 2 -L '^(volume|session)$' -R '[Ff]rames|workspace|thread|cancel' ||
        status=1
    on_display ctest --preset dev-tsan --parallel 2 -L '^gui$' -R 'job|player|played|series|[Ff]rame|cancel|while|optimiz' || status=1
    return $status
}

check_fuzz() {
    scripts/fuzz.sh 60
}

check_zink() {
    scripts/setup.sh mesa-vulkan-drivers
    scripts/build.sh test_gl test_golden
    # Without the last variable Mesa 22.3 builds values of uniforms into shaders and runs old ones for new values: of two
    # dispatches of a program the second one sees the planes of an earlier sweep.
    LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=zink PELLUCID_REQUIRE_GL=1 PELLUCID_GL_DEBUG=1 ZINK_INLINE_UNIFORMS=0 \
        ctest --preset release --parallel 2 -L '^(gl|golden)$' -E OSMesa
}

check_tidy() {
    need run-clang-tidy clang-tidy
    cmake --preset dev >/dev/null
    local changed
    changed=$(git diff --name-only --diff-filter=d "${PELLUCID_BASE:-HEAD~1}" -- 'src/*.cpp' 'app/*.cpp')
    [ -z "$changed" ] || run-clang-tidy -quiet -p build/dev $changed
}

by=
end=
checks=()
while [ $# -gt 0 ]; do
    if [ "$1" = --by ]; then
        by=${2:?--by needs seconds}
        shift
    elif [ "$1" = --end ]; then
        end=${2:?--end needs seconds}
        shift
    elif [[ " ${all[*]} " == *" $1 "* ]]; then
        checks+=("$1")
    else
        echo "check: no check is called '$1'; there are ${all[*]}" >&2
        exit 2
    fi
    shift
done
[ ${#checks[@]} -gt 0 ] || checks=("${all[@]}")

# For the script that calls itself below.
if [ "${PELLUCID_CHECK_ALONE:-}" = "${checks[*]}" ]; then
    "check_${checks[0]}"
    exit
fi

failed=0
start=$SECONDS
for check in "${checks[@]}"; do
    began=$SECONDS
    gone=$((began - start))
    if [ $gone -ge "${by:-$((gone + 1))}" ] || [ $gone -ge "${end:-$((gone + 1))}" ]; then
        echo "check: $check: left out, no time"
        continue
    fi
    # A program of its own: what it started can be stopped with it, and `set -e` ends it at its first error.
    alone=(scripts/check.sh "$check")
    [ -z "$end" ] || alone=(timeout --kill-after 30 $((end - gone)) "${alone[@]}")
    status=0
    PELLUCID_CHECK_ALONE=$check "${alone[@]}" || status=$?
    if [ $status -eq 0 ]; then
        echo "check: $check: passed in $((SECONDS - began)) s"
    elif [ -n "$end" ] && [ $status -eq 124 ]; then
        echo "check: $check: stopped after $((SECONDS - began)) s, no time"
    else
        echo "check: $check: FAILED after $((SECONDS - began)) s" >&2
        failed=1
    fi
done
exit $failed
