#!/usr/bin/env bash
# Writes what the commands of README.md, docs/guide.md and docs/how-to print now into these documents: every command behind a `$`
# whose output is shown. tests/cli/examples_test.cpp says by which rules. Then docs/texts.md, and docs/reproduce.md by `reproduce`, which
# takes some minutes the first time. Look at `git diff` after.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
cmake --build "$build" --target pellucid-cli test_cli test_layering
real=../shared/data/real
# Software draws no faster than the cpu, so that the figures are those of one engine on every machine.
PELLUCID_GL_PLATFORM=osmesa "$build/bin/pellucid-cli" reproduce --out "$build/reproduce" --index docs/reproduce.md \
    $([[ -d $real ]] && echo "--data $real")
PELLUCID_REFRESH_DOCS=1 "$build/bin/test_cli" '[documents]'
PELLUCID_REFRESH_DOCS=1 "$build/bin/test_layering" '[texts]'
