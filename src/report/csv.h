// Curves as tables (CSV, RFC 4180): commas, a header line, texts in quotes where they need them.
#pragma once

#include <span>
#include <string>

#include "session/session.h"

namespace pellucid {

/// `text` as one field. What a spreadsheet would take for a formula (= + − @ in front) gets an apostrophe before it.
std::string csvField(const std::string& text);

/// A line per state of each run: run, method, move (0: the start), level (see OptimizeState), F, then for each
/// feature its VWS, its target and its opacity. Features of several runs are found by their names; where a run has no
/// such feature the fields are empty. Numbers with all their digits.
std::string csvOf(std::span<const Run* const> runs);

} // namespace pellucid
