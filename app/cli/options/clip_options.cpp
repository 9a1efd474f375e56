#include "options/clip_options.h"

#include <algorithm>

namespace pellucid::cli {

namespace {
constexpr const char* kOption = "--clip";
constexpr const char* kHolder = "--holder";
} // namespace

void ClipOptions::add(CLI::App& app) {
    addRepeated(
        app, kOption, "x:A:B|NX,NY,NZ,D", clips, parseClip,
        "look at this part of the box alone, along x, y or z of its grid in fractions from 0 to 1; or at the points p "
        "of the world with NX*px + NY*py + NZ*pz <= D. What is cut away has opacity 0 in pictures and figures",
        "View");
    addValue(
        app, kHolder, "D", holder, realFrom(0, 1),
        "how strongly the board or holder under the object is drawn: 0 leaves it out, 1 draws and measures it like the "
        "rest. An automatic start finds it and draws it faintly; below 1 it is not measured, but still dims what lies "
        "behind it",
        "View");
}

void ClipOptions::applyTo(SceneInputs& inputs) const {
    inputs.holder = holder;
    if (clips.empty()) return;
    Clipping left;
    left.rest = inputs.session.clipping->rest;
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

void ClipOptions::check(const Scene& scene) const {
    if (!holder || *holder == 1 || !scene.session.clipping->rest.isNone()) return;
    throw UsageError("no board or holder has been found", kHolder,
                     scene.proposal ? "leave it out, or use --clip" : "only an automatic start looks for one");
}

} // namespace pellucid::cli
