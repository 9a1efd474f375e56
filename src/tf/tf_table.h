// The transfer function as renderers read it: equidistant samples.
#pragma once

#include <array>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid {

/// Entry i holds intensity i/(size−1).
struct TfTable {
    int size = 0;
    std::vector<std::array<float, 4>> rgba; ///< straight (not premultiplied) sRGB in [0,1], α of a path of d0
    std::vector<float> opticalDepth;        ///< −ln(1 − α), α capped: optical depth of a path of d0

    std::size_t index(double s) const { return static_cast<std::size_t>(std::clamp(s, 0.0, 1.0) * (size - 1) + 0.5); }
};

TfTable makeTfTable(const TransferFunction& tf, int size);

} // namespace pellucid
