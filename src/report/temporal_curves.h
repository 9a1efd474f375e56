// The curves of a series (thesis figures 5.12 and 5.13): what features get of attention from frame to frame, under a
// static transfer function and under one that follows the frames.
#pragma once

#include <string>
#include <vector>

#include "report/plot.h"
#include "session/frame_figures.h"

namespace pellucid {

/// The frames of a series under one way to choose transfer functions.
struct TemporalRun {
    std::string name; ///< "static", "optimize"
    std::vector<FrameFigures> frames;
};

struct TemporalCurves {
    std::vector<std::string> features;
    std::vector<Rgb> colors;       ///< of the features
    std::vector<TemporalRun> runs; ///< of the same series; where two are compared the second is the static one
    int present = -1;              ///< a frame that is pointed out; −1: none
    bool empty() const;            ///< no frame could be read
    bool hasPictures() const;      ///< of some frame 2D feature saliency is known
    bool hasEnergies() const;      ///< some frame was refined
};

/// VWS of each feature in its colour over the frames of one run, targets dashed. Frames that cannot be read are gaps.
/// `highest`: upper end of the axis; 0: what fits.
Plot temporalVwsPlot(const TemporalCurves& curves, std::size_t run, double highest = 0);
/// FV of each feature.
Plot temporalVisibilityPlot(const TemporalCurves& curves, std::size_t run);
/// 2D feature saliency of each feature (figs 5.12b, 5.13b), where hasPictures().
Plot temporalPicturePlot(const TemporalCurves& curves, std::size_t run);
/// Opacity of each feature's peak (α of a path of length d0).
Plot temporalOpacityPlot(const TemporalCurves& curves, std::size_t run, bool logarithmic = false);
/// F of all runs.
Plot temporalObjectivePlot(const TemporalCurves& curves);
/// Flicker of all runs, mean ΔE.
Plot temporalFlickerPlot(const TemporalCurves& curves);

/// All of them: VWS of each run with a common axis, F, flicker, then FV, 2D feature saliency and opacities of each run.
std::vector<Plot> temporalPlots(const TemporalCurves& curves);

/// A line per frame of each run: run, frame, file, time, F, flicker, moves, seconds, where hasEnergies() the energy
/// that a refinement has left over the movable edges, then for each feature its VWS, its target, its FV, its opacity
/// and, where hasPictures(), its 2DFS, and why the frame could not be read. What is not known is empty. Numbers with
/// all their digits.
std::string csvOf(const TemporalCurves& curves);

} // namespace pellucid
