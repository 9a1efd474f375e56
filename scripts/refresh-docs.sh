#!/usr/bin/env bash
# Writes what the commands of README.md, docs/guide.md and docs/reproduce.md print now into these documents: every
# command behind a `$` whose output is shown. tests/cli/examples_test.cpp says by which rules. Look at `git diff` after.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
cmake --build "$build" --target pellucid-cli test_cli
PELLUCID_REFRESH_DOCS=1 "$build/bin/test_cli" '[documents]'
