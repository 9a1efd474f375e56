// The curves of runs as a table.
#pragma once

#include <span>
#include <string>

#include "session/session.h"

namespace pellucid {

/// A line per state of each run: run, method, move (0: the start), level (see OptimizeState), F, then for each
/// feature its VWS, its target and its opacity. Features of several runs are found by their names; where a run has no
/// such feature the fields are empty. Numbers with all their digits.
std::string csvOf(std::span<const Run* const> runs);

} // namespace pellucid
