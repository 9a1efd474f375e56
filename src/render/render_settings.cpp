#include "render/render_settings.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/error.h"

namespace pellucid {

namespace {
constexpr std::array<const char*, 5> kModes{"composite", "mip", "minip", "average", "surface"};
}

const char* name(RenderMode mode) { return kModes[static_cast<std::size_t>(mode)]; }

std::optional<RenderMode> renderModeFromName(const std::string& name) {
    for (std::size_t i = 0; i < kModes.size(); ++i)
        if (name == kModes[i]) return static_cast<RenderMode>(i);
    return {};
}

void RenderSettings::validate() const {
    constexpr int kMaxPixels = 16384;
    if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels)
        throw UsageError("an image has 1 to 16384 pixels along each side", "image size", "give such a size");
    if (!(stepInD0 > 0 && stepInD0 <= 16))
        throw UsageError("the step lies in (0, 16] reference lengths", "step", "give such a step");
    if (finestInD0 && !(*finestInD0 >= kFinestStep && *finestInD0 <= 16))
        throw UsageError("the finest step lies in [1/256, 16] reference lengths", "finest step", "give such a step");
    clipping.validate();
    const auto within = [](double value, double lo, double hi) { return value >= lo && value <= hi; };
    for (const double share : {light.gradientOpacity, light.occlusion, light.depthCue, light.silhouettes})
        if (!within(share, 0, 1))
            throw UsageError("a strength of light lies in [0, 1]", "light", "give such a strength");
    for (const double part : {light.ambient, light.diffuse, light.specular})
        if (!within(part, 0, 2))
            throw UsageError("ambient, diffuse and specular light lie in [0, 2]", "light", "give such parts");
    if (!within(light.shininess, 1, 1000))
        throw UsageError("the shininess lies in [1, 1000]", "light", "give such an exponent");
    const double length = glm::length(light.direction);
    if (!(length > 0) || !std::isfinite(length))
        throw UsageError("the light needs a direction", "light", "give one that is finite and not 0");
}

int RenderSettings::halvings() const {
    if (mode != RenderMode::Composite || !finestInD0 || *finestInD0 >= stepInD0) return 0;
    return static_cast<int>(std::log2(stepInD0 / *finestInD0) + 1e-9);
}

double RenderSettings::smallestStep() const { return std::ldexp(stepInD0, -halvings()); }

const Feature* RenderSettings::featureAlone(const TransferFunction& tf) const {
    if (onlyFeature == -1) return nullptr;
    if (onlyFeature >= 0 && static_cast<std::size_t>(onlyFeature) < tf.features.size())
        return &tf.features[static_cast<std::size_t>(onlyFeature)];
    throw UsageError("there is no feature number " + std::to_string(onlyFeature), "transfer function",
                     "it has " + std::to_string(tf.features.size()) + ", counted from 0");
}

} // namespace pellucid
