#include "session/frame_figures.h"

#include <array>
#include <cmath>

#include "engines/engines.h"
#include "tf/color_difference.h"

namespace pellucid {

FrameFigures figuresOf(const Scene& scene, const TransferFunction* before, Workspace& workspace,
                       const JobControl& job) {
    FrameFigures figures;
    figures.frame = scene.session.frame;
    figures.file = scene.series->listing().fileOf(figures.frame);
    figures.time = scene.series->listing().frames[static_cast<std::size_t>(figures.frame)].time;
    figures.targets = scene.targets();
    figures.empty = emptyFeatures(scene.tf, *scene.histogram);
    const Measures measures = workspace.measure(measureInput(scene), {job.stop, {}});
    for (const FeatureMeasures& feature : measures.features) {
        figures.vws.push_back(feature.vws);
        figures.visibility.push_back(feature.visibility);
    }
    figures.opacity = measures.opacities;
    if (!figures.vws.empty()) figures.objective = objectiveOf(figures.vws, figures.targets);
    if (before == nullptr) return figures;
    figures.flicker = 0;
    if (*before == scene.tf) return figures;
    const auto renderer = makeRenderer(scene.session.measure->engine, scene.volume);
    std::array<Image, 2> pictures;
    Scene shown = scene;
    shown.overlay.reset();
    for (std::size_t i = 0; i < 2; ++i) {
        if (i == 1) shown.tf = *before;
        PictureInput picture = pictureInput(shown, kFlickerSize, kFlickerSize);
        picture.settings.finestInD0.reset(); // nor on how finely
        pictures[i] = renderer->render(picture.camera, picture.tf, picture.settings, {job.stop, {}});
    }
    figures.flicker = meanDeltaE(pictures[0], pictures[1]);
    return figures;
}

FrameFigures brokenFigures(const TimeSeries& series, int frame) {
    FrameFigures figures;
    figures.frame = frame;
    figures.file = series.listing().fileOf(frame);
    figures.time = series.listing().frames[static_cast<std::size_t>(frame)].time;
    figures.problem = series.summary(frame).problem;
    if (figures.problem.empty()) figures.problem = "it cannot be read";
    return figures;
}

int neighbourBefore(const TimeSeries& series, int frame, bool overGaps) {
    int before = frame - 1;
    if (!overGaps && series.listing().frames.at(static_cast<std::size_t>(frame)).afterGap) return -1;
    while (before >= 0 && !series.summary(before).problem.empty()) {
        if (!overGaps) return -1;
        --before;
    }
    return before;
}

SequenceFigures summaryOf(const std::vector<FrameFigures>& frames, double tolerance) {
    SequenceFigures sums;
    int flickers = 0, made = 0;
    for (const FrameFigures& f : frames) {
        if (!f.problem.empty()) {
            ++sums.broken;
            continue;
        }
        ++sums.frames;
        sums.rms += f.objective * f.objective;
        sums.above += f.objective < tolerance ? 0 : 1;
        if (sums.worst < 0 || f.objective > sums.worstObjective) {
            sums.worst = f.frame;
            sums.worstObjective = f.objective;
        }
        if (f.flicker) {
            sums.flicker += *f.flicker;
            ++flickers;
        }
        if (f.moves) {
            sums.moves += *f.moves;
            sums.seconds += f.seconds;
            ++made;
        }
    }
    if (sums.frames > 0) sums.rms = std::sqrt(sums.rms / sums.frames);
    if (flickers > 0) sums.flicker /= flickers;
    if (made > 0) {
        sums.moves /= made;
        sums.seconds /= made;
    }
    return sums;
}

} // namespace pellucid
