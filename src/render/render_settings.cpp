#include "render/render_settings.h"

#include "base/error.h"

namespace pellucid {

void RenderSettings::validate() const {
    constexpr int kMaxPixels = 16384;
    if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels)
        throw UsageError("an image has 1 to 16384 pixels along each side", "image size", "give such a size");
    if (!(stepInD0 > 0 && stepInD0 <= 16))
        throw UsageError("the step lies in (0, 16] reference lengths", "step", "give such a step");
    for (int a = 0; a < 3; ++a)
        if (!(clipLo[a] >= 0 && clipLo[a] < clipHi[a] && clipHi[a] <= 1))
            throw UsageError("a clip interval needs 0 <= a < b <= 1", "clip", "give fractions of the box");
}

const Feature* RenderSettings::featureAlone(const TransferFunction& tf) const {
    if (onlyFeature == -1) return nullptr;
    if (onlyFeature >= 0 && static_cast<std::size_t>(onlyFeature) < tf.features.size())
        return &tf.features[static_cast<std::size_t>(onlyFeature)];
    throw UsageError("there is no feature number " + std::to_string(onlyFeature), "transfer function",
                     "it has " + std::to_string(tf.features.size()) + ", counted from 0");
}

} // namespace pellucid
