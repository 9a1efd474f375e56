#include "render/picture_layers.h"

#include <string>

#include "base/error.h"
#include "render/cpu/ray_packets.h"

namespace pellucid {

void checkLayers(const TransferFunction& tf, const RenderSettings& settings) {
    settings.validate();
    if (settings.mode != RenderMode::Composite)
        throw UsageError("only pictures by emission and absorption have layers", "the way to draw",
                         "choose the mode composite");
    if (settings.ground) throw UsageError("a picture over a ground has no layers", "the ground", "leave it out");
    if (settings.overlay) throw UsageError("a picture with an overlay has no layers", "the overlay", "leave it out");
    if (tf.features.size() >= kMostSurfaces)
        throw UsageError(std::to_string(tf.features.size()) + " features are too many for layers",
                         "the transfer function", "use at most " + std::to_string(kMostSurfaces - 1));
}

double bytesOfLayers(int width, int height, std::size_t features) {
    const double floats = 4.0 * static_cast<double>(features + 2) + 1 + 3; // picture and rest; depth; normals
    return floats * sizeof(float) * width * height;
}

} // namespace pellucid
