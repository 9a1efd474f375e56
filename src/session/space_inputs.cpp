#include "session/space_inputs.h"

#include <algorithm>

#include "base/check.h"
#include "volume/coarser_colors.h"
#include "volume/excerpt.h"

namespace pellucid {

namespace {

/// `number`: of a run that has none.
std::string nameOf(const Run& run, int number) {
    if (!run.name.empty()) return run.name;
    return "run " + std::to_string(run.number > 0 ? run.number : number) +
           (run.hasStart() ? std::string(", ") + name(run.start->options.method) : std::string());
}

} // namespace

MeasureInput coarserInput(const MeasureInput& input, int factor) {
    PELLUCID_CHECK(factor >= 1);
    if (factor == 1) return input;
    MeasureInput coarser = input;
    coarser.volume = std::make_shared<const Volume>(coarserCopy(*input.volume, factor));
    if (input.colors) coarser.colors = std::make_shared<const VoxelColors>(coarserColors(*input.colors, factor));
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
        SpacePath path{nameOf(run, number), pathColor(paths.size()), {}, run.best};
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
