#!/usr/bin/env bash
# Fuzzes the parsers that are ours: scripts/fuzz.sh [SECONDS] [TARGET…], each for 60 seconds where nothing is said, two
# at a time (PELLUCID_FUZZ_JOBS: how many). `volumes`, `readers` and `documents` stand for those of volume files, those
# of what the programs parse that read foreign formats, and those of all other files, which are all.
# Sets up and builds with clang what it needs, into build/fuzz. Inputs that reach new code are kept there, in corpus/,
# and the next run begins with them. PELLUCID_FUZZ_SEED: another sequence of inputs than that of seed 1.
# Exit status 1 at the first input that fails; it is kept in build/fuzz/failures, and what to do with it is said.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=60
if [[ ${1:-} =~ ^[1-9][0-9]*$ ]]; then
    seconds=$1
    shift
fi
volumes=(nrrd nhdr mha mhd nifti nifti_gz vti pvti pvd vtk pvm dat vvd mrml xml_tags raw inflate bzip2 reader_messages)
readers=(zarr netcdf page_words dicom_stack)
documents=(tf_json tfi camera_json session_json study_json answers reproduction_json words)
[ $# -gt 0 ] || set -- volumes readers documents
targets=() programs=()
for word in "$@"; do
    case $word in
        volumes) targets+=("${volumes[@]}") programs+=(fuzz_volumes) ;;
        readers) targets+=("${readers[@]}") programs+=(fuzz_readers) ;;
        documents) targets+=("${documents[@]}") programs+=(fuzz_documents) ;;
        *)
            [[ " ${volumes[*]} ${readers[*]} ${documents[*]} " == *" $word "* ]] || {
                echo "fuzz: no target is called '$word'; there are ${volumes[*]} ${readers[*]} ${documents[*]}" >&2
                exit 2
            }
            group=document
            [[ " ${volumes[*]} " != *" $word "* ]] || group=volume
            [[ " ${readers[*]} " != *" $word "* ]] || group=reader
            targets+=("$word") programs+=("fuzz_$word" "fuzz_${group}_seeds")
            ;;
    esac
done

scripts/setup.sh clang libclang-rt-14-dev llvm
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "${programs[@]}"

# Inputs are files while they are read: of a folder in memory, where there is one.
TMPDIR=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")" pellucid-fuzz-XXXXXX)
trap 'wait; rm -rf "$TMPDIR"' EXIT # what still runs needs the folder
export TMPDIR
seed=${PELLUCID_FUZZ_SEED:-1}
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=quarantine_size_mb=64
# What an input may take: 5 s, 512 MiB at once, 2 GiB in all, those of the sanitizers included.
limits=(-timeout=5 -malloc_limit_mb=512 -rss_limit_mb=2048)
rm -rf build/fuzz/seeds
for group in volume reader document; do
    [[ " ${programs[*]} " != *" fuzz_$group"@(s|_seeds)" "* ]] || "build/fuzz/bin/fuzz_${group}_seeds" build/fuzz/seeds
done
mkdir -p build/fuzz/corpus build/fuzz/failures build/fuzz/logs

# Runs one target.
fuzz() {
    local target=$1 program=build/fuzz/bin/fuzz_$1 log=build/fuzz/logs/$1.log dictionary=()
    [ ! -f "build/fuzz/seeds/$target.dict" ] || dictionary=("-dict=build/fuzz/seeds/$target.dict")
    mkdir -p "build/fuzz/corpus/$target"
    if "$program" -seed="$seed" -max_total_time="$seconds" "${limits[@]}" "${dictionary[@]}" \
        -artifact_prefix="build/fuzz/failures/$target-" "build/fuzz/corpus/$target" "build/fuzz/seeds/$target" \
        >"$log" 2>&1; then
        echo "fuzz: $target: $(sed -n 's/^Done \([0-9]*\) runs in \([0-9]*\) .*/\1 inputs in \2 s/p' "$log")," \
            "$(grep -o 'cov: [0-9]*' "$log" | tail -1 | cut -d' ' -f2) edges, seed $seed: passed"
        return 0
    fi
    local input
    input=$(sed -n 's/.*Test unit written to //p' "$log" | tail -1)
    grep -E 'ERROR|SUMMARY|runtime error|broken promise|terminate|what\(\)|    #[0-9] ' "$log" | head -16 >&2 || true
    echo "fuzz: $target: FAILED with seed $seed, see $log" >&2
    echo "fuzz: again: $program ${limits[*]} ${input:-(no input was kept)}" >&2
    return 1
}

# `wait -n` ends the script with the first that fails.
jobs=${PELLUCID_FUZZ_JOBS:-2}
for i in "${!targets[@]}"; do
    [ "$i" -lt "$jobs" ] || wait -n
    fuzz "${targets[i]}" &
done
for i in "${!targets[@]}"; do
    [ "$i" -ge "$jobs" ] || wait -n
done
