// How a long computation is watched and stopped.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

#include "base/error.h"

namespace pellucid {

/// Handed to everything that may take over a second. Default: runs to the end, tells nobody.
struct JobControl {
    std::stop_token stop;                 ///< asked between pieces of work
    std::function<void(double)> progress; ///< fraction done in [0,1]; may be called from any thread; may be empty

    void throwIfStopped() const {
        if (stop.stop_requested()) throw Cancelled{};
    }
    void report(double fraction) const {
        if (progress) progress(fraction);
    }
    /// For the n-th of `count` equal parts of the work. Refers to this, which outlives it.
    JobControl part(std::size_t n, std::size_t count) const {
        if (!progress) return {stop, {}};
        return {stop,
                [this, n, count](double f) { progress((static_cast<double>(n) + f) / static_cast<double>(count)); }};
    }
};

} // namespace pellucid
