#include "options/clip_options.h"

#include <algorithm>

namespace pellucid::cli {

namespace {
constexpr const char* kOption = "--clip";
}

void ClipOptions::add(CLI::App& app) {
    addRepeated(
        app, kOption, "x:A:B|NX,NY,NZ,D", clips, parseClip,
        "look at this part of the box alone, along x, y or z of its grid in fractions from 0 to 1; or at the points p "
        "of the world with NX*px + NY*py + NZ*pz <= D. What is cut away has opacity 0 in pictures and figures",
        "View");
}

void ClipOptions::applyTo(SceneInputs& inputs) const {
    if (clips.empty()) return;
    Clipping left;
    for (const Clip& clip : clips) {
        if (const auto* plane = std::get_if<ClipPlane>(&clip)) {
            left.planes.push_back(*plane);
            continue;
        }
        const auto& part = std::get<ClipAxis>(clip);
        left.lo[part.axis] = std::max(left.lo[part.axis], part.lo);
        left.hi[part.axis] = std::min(left.hi[part.axis], part.hi);
        if (!(left.lo[part.axis] < left.hi[part.axis]))
            throw UsageError("nothing is left between the clips of one axis", kOption, "let them overlap");
    }
    atOption(kOption, [&] { left.validate(); });
    inputs.session.clipping.set(left);
}

} // namespace pellucid::cli
