// What the frames of a series show, as figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/workspace.h"

namespace pellucid {

/// What a frame shows under a transfer function.
struct FrameFigures {
    int frame = 0;
    std::string file;               ///< see SeriesListing::fileOf()
    double time = 0;                ///< see SeriesFrame
    std::string problem;            ///< why it could not be read: the rest is empty then
    std::vector<double> vws;        ///< W, per feature
    std::vector<double> visibility; ///< FV
    std::vector<double> opacity;    ///< of the peaks
    std::vector<double> fs;         ///< 2D feature saliency of its picture; empty: nobody has looked at one
    std::vector<double> targets;    ///< shares
    std::vector<bool> empty;        ///< whether the frame has no voxel of it
    double objective = 0;           ///< F
    std::optional<double> flicker;  ///< mean ΔE to the same frame under the transfer function of neighbourBefore()
    std::optional<int> moves;       ///< that its transfer function took; empty: none was made for it
    double seconds = 0;             ///< likewise, reading included
    std::optional<double> energy;   ///< that a refinement has left over the movable edges; empty: none was made for it
};

/// The frame that flicker of `frame` compares it with: the one before, where it can be read as far as is known and no
/// number is missing between the two; with `overGaps` the nearest before it that can be read. −1: none.
int neighbourBefore(const TimeSeries& series, int frame, bool overGaps);

inline constexpr int kFlickerSize = 256; ///< pixels of the side of the pictures that flicker is measured on

/// Figures of the scene's frame. `before`: the transfer function of the frame before, in the window of the scene;
/// null: no flicker.
FrameFigures figuresOf(const Scene& scene, const TransferFunction* before, Workspace& workspace,
                       const JobControl& job = {});
/// The same without what needs pictures or sweeps: a frame that cannot be read.
FrameFigures brokenFigures(const TimeSeries& series, int frame);

/// Of several frames: root mean square of F over those that could be read; mean flicker over those that have one; moves
/// and seconds on average over those that were made.
struct SequenceFigures {
    double rms = 0, flicker = 0, moves = 0, seconds = 0;
    int frames = 0, broken = 0;
    int worst = -1;            ///< the frame of the largest F, the first of several; −1: none could be read
    double worstObjective = 0; ///< that F
    int above = 0;             ///< frames with F not below the tolerance
};
SequenceFigures summaryOf(const std::vector<FrameFigures>& frames, double tolerance = OptimizeOptions{}.tolerance);

} // namespace pellucid
