#include "session/space_inputs.h"

#include <algorithm>

#include <glm/common.hpp>

#include "base/check.h"
#include "volume/excerpt.h"

namespace pellucid {

MeasureInput coarserInput(const MeasureInput& input, int factor) {
    PELLUCID_CHECK(factor >= 1);
    if (factor == 1) return input;
    const Volume& whole = *input.volume;
    ExcerptPlan plan;
    plan.region = {Int3(0), whole.dims()};
    plan.factors = glm::min(Int3(factor), whole.dims());
    plan.dims = (whole.dims() + plan.factors - 1) / plan.factors;
    plan.excerpt = {whole.dims(), plan.region, factor, false};
    const Volume coarse = excerptOf(whole, plan);
    Geometry geometry = coarse.geometry();
    geometry.referenceLength = whole.geometry().d0();
    Volume volume(geometry, coarse.samples(), coarse.missing());
    volume.title = whole.title;
    volume.format = whole.format;
    volume.excerpt = plan.excerpt;
    MeasureInput coarser = input;
    coarser.volume = std::make_shared<const Volume>(throughWindowOf(std::move(volume), whole.range()));
    return coarser;
}

std::vector<SpacePath> pathsOfRuns(const std::vector<Run>& runs, const TransferFunction& tf,
                                   const ParameterAxes& axes) {
    std::vector<SpacePath> paths;
    int number = 0;
    for (const Run& run : runs) {
        if (run.kind != "optimize" || run.history.empty()) continue;
        ++number;
        const auto placeOf = [&](std::size_t feature) {
            return static_cast<std::size_t>(
                std::find(run.features.begin(), run.features.end(), tf.features[feature].name) - run.features.begin());
        };
        if (std::any_of(axes.features.begin(), axes.features.end(),
                        [&](std::size_t f) { return placeOf(f) == run.features.size(); }))
            continue;
        SpacePath path{"run " + std::to_string(number), pathColor(paths.size()), {}, run.best};
        for (const OptimizeState& state : run.history) {
            OptimizeState one = state;
            one.opacity.assign(tf.features.size(), 0.0);
            one.vws = one.opacity;
            for (std::size_t f = 0; f < tf.features.size(); ++f) {
                const std::size_t place = placeOf(f);
                if (place >= state.opacity.size()) continue;
                one.opacity[f] = state.opacity[place];
                if (place < state.vws.size()) one.vws[f] = state.vws[place];
            }
            path.states.push_back(std::move(one));
        }
        paths.push_back(std::move(path));
    }
    return paths;
}

} // namespace pellucid
