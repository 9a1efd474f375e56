// What the script of a page reads beside the voxels: one JSON object.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "optimize/answer/density_curve.h"
#include "optimize/measure.h"
#include "session/scene.h"
#include "share/packed_voxels.h"

namespace pellucid {

/// Figures of the saved view.
struct ShareFigures {
    std::vector<FeatureMeasures> features; ///< in the order of the features; empty: there are none
    std::optional<DensityCurve> curve;
};

struct SceneBlock {
    std::string title;
    const Scene& scene;         ///< what is seen, with all voxels
    const RenderSettings& look; ///< how it is drawn
    const Volume& volume;       ///< as it is in the page, maybe coarser
    int factor = 1;             ///< by which it is
    ShareCodes codes;
    std::size_t packedBytes = 0;
    std::optional<Int3> openness; ///< cells of ambient occlusion, behind the voxels
    const ShareFigures& figures;
};

/// Names of features and the title are texts of people; nothing else that a file says of itself is in it.
nlohmann::json jsonOf(const SceneBlock& block);

} // namespace pellucid
