// Transfer functions that are made frame by frame, and smoothed together (docs/method.md, "Transfer functions over
// time").
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "optimize/time/smoothing.h"
#include "session/adapt_tasks.h"
#include "session/workspace.h"

namespace pellucid {

/// `tf` of the same data values in another window; as it is where it says of no values, or the window holds one.
TransferFunction writtenFor(const TransferFunction& tf, const ValueRange& window);

/// The scene of another frame under a given transfer function; everything else is that of `basis`. Where `basis` is of
/// that frame, no data is read. Throws as resolve() does.
Scene sceneAt(const Scene& basis, int frame, const TransferFunction& tf, const JobControl& job = {});

/// What a refinement did to the energies (docs/method.md, "Entropy refinement").
struct RefineEnergies {
    double before = 0, after = 0;               ///< over all edges
    double movableBefore = 0, movableAfter = 0; ///< over those that take part, decides
};

/// What was made for a frame.
struct AdaptedFrame {
    int frame = 0;
    TransferFunction tf;                  ///< written for the scene's window, features with their identities
    std::string basis;                    ///< that of the task
    std::optional<RefineEnergies> energy; ///< of a refinement
    RefinePriority priority;              ///< of a refinement: what it brought out
    std::vector<double> vws;              ///< of an optimization: W, per feature
    std::optional<double> objective;      ///< of an optimization: F
    int moves = 0;                        ///< of an optimization; iterations of a refinement
    double seconds = 0;                   ///< reading included
    AdaptedTf forTrack() const { return {Part<TransferFunction>(tf), basis}; }
};

/// What came out of a SmoothTask.
struct SmoothedFrames {
    std::map<int, TransferFunction> tfs; ///< by frame
    std::map<int, std::string> from;     ///< fingerprints of what they came from, by frame
    std::string basis;                   ///< that of the task
    double seconds = 0;                  ///< of all frames together, reading included
};

/// Makes transfer functions frame by frame, and smooths them. Keeps what frames share, and models of frames that are
/// to be smoothed; used by one thread at a time.
class FrameAdapter {
public:
    /// The transfer function of the task's frame, under the settings of basis.session; reads the frame. Throws
    /// FileError where that is broken (it is known as such then, see nextToAdapt()), Cancelled, and as
    /// Workspace::measure() does.
    AdaptedFrame adapt(const Scene& basis, const AdaptTask& task, Workspace& workspace, const JobControl& job = {});

    /// The transfer functions of these frames, optimized: with as little change from frame to frame as the distance of
    /// the coherence allows on average; refined: with steps that its weight holds back. That at the next key stays.
    /// Reads the frames to optimize, those adapted here before only once.
    /// Throws FileError where one is broken (it is known as such then), Cancelled, and as Workspace::measure() does.
    SmoothedFrames smooth(const Scene& basis, const SmoothTask& task, Workspace& workspace, const JobControl& job = {});

private:
    struct Known {
        std::string basis; ///< of the transfer function that the model is of
        FrameModel model;
    };
    /// Those of the task's key frame, whatever lies there later.
    const std::vector<RegionColor>& regionOf(const Scene& basis, const AdaptTask& task, const JobControl& job);
    void refine(const Scene& frame, const Scene& basis, const AdaptTask& task, AdaptedFrame& made,
                const JobControl& job);

    std::string m_regionBasis; ///< what m_colors were taken from
    std::vector<RegionColor> m_colors;
    std::map<int, Known> m_models;
};

/// The session with that transfer function in its track.
Session withAdapted(Session session, int frame, AdaptedTf adapted);
/// The session with those that were smoothed beside those that they came from, where these are still there.
Session withSmoothed(Session session, const SmoothedFrames& smoothed);

} // namespace pellucid
