// From where a volume is looked at, and how much of it.
#pragma once

#include "render/clipping.h"

namespace pellucid {

/// A camera alone looks at the whole volume.
struct View {
    Camera camera;
    Clipping clipping; ///< what is cut away has opacity 0

    View() = default;
    View(const Camera& from, Clipping part = {}) : camera(from), clipping(std::move(part)) {}
    bool operator==(const View&) const = default;
};

} // namespace pellucid
