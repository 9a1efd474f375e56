// How long searches take with ever more threads, as curves (thesis figure 5.11).
#pragma once

#include <span>

#include "bench/bench.h"
#include "report/plot.h"

namespace pellucid::cli {

/// A curve per volume and transfer function of the rows BenchRow::Threads among `rows`, and dashed what each would take
/// if n threads needed 1/n of the time. A band shows where there are more threads than processors.
Plot threadsPlot(std::span<const BenchResult> rows);

} // namespace pellucid::cli
