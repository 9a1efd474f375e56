#include "tf/tf_table.h"

#include "base/check.h"
#include "tf/opacity.h"

namespace pellucid {

TfTable makeTfTable(const TransferFunction& tf, int size) {
    PELLUCID_CHECK(size >= 2);
    TfTable table;
    table.size = size;
    table.rgba.resize(static_cast<std::size_t>(size));
    table.opticalDepth.resize(static_cast<std::size_t>(size));
    const TfSampler sampler(tf);
    for (std::size_t i = 0; i < table.rgba.size(); ++i) {
        const double s = static_cast<double>(i) / (size - 1);
        const double alpha = sampler.opacity(s);
        const Rgb c = sampler.color(s);
        table.rgba[i] = {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b),
                         static_cast<float>(alpha)};
        table.opticalDepth[i] = static_cast<float>(opticalDepthOfOpacity(alpha));
    }
    return table;
}

} // namespace pellucid
