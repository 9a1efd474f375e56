// Threads. Work is cut into pieces whose number depends on the data alone, never on the thread count, so that
// every result has the same bits with one thread and with sixteen.
#pragma once

#include <cstddef>
#include <functional>

namespace pellucid {

/// Threads used from now on by parallelFor, in the whole process; 0 means all that the machine has.
void setThreadCount(int threads);
int threadCount();

/// Calls body(i) for each i in [0, count), begun in this order, on any thread. The first exception is rethrown here,
/// and what had not begun is left out. For a reduction let piece i write slot i, then add the slots up in order.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

} // namespace pellucid
