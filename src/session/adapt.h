// Transfer functions that follow the frames of a series (docs/method.md, "Transfer functions over time"): which are to
// be made anew, how one is made, and what a frame shows under it. For the window and the command line alike.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "optimize/time/smoothing.h"
#include "session/workspace.h"

namespace pellucid {

/// A transfer function that is to be made, from that of the frame before.
struct AdaptTask {
    int frame = 0;
    int key = 0;               ///< the key frame that it goes back to; its own where it is that
    TransferFunction previous; ///< what it starts from: that of the frame before, or the key
    std::string basis;         ///< fingerprintOf() of these
};

/// Text that is the same exactly where a frame's adapted transfer function would be: a hash of the frame's data, their
/// window, the transfer function it starts from, AdaptSettings, and of what its mode depends on: settings of refinement
/// (and, where a region is favoured, the view, clipping and the key's transfer function), or targets of this frame,
/// limits, settings of optimization and measuring, view, clipping and colours of several variables. Files count by
/// their names and sizes, so that a session can be moved. `session` is any frame's.
std::string fingerprintOf(const Session& session, const TimeSeries& series, int frame,
                          const TransferFunction& previous);

/// The next frame whose transfer function is missing or stale: of the frames that go back to the key of the session's
/// present frame first, then of the other keys; each time the first. Frames that are known to be broken, and those
/// before the first key, have none. Empty where all are there, and in the mode Static. Reads nothing.
std::optional<AdaptTask> nextToAdapt(const Session& session, const TimeSeries& series);
/// The frame of nextToAdapt(); −1: none.
int firstStale(const Session& session, const TimeSeries& series);
/// How many frames have a transfer function that is not stale, and how many should; and to how many of these it is true
/// that they are smoothed, or need not be.
struct AdaptProgress {
    int done = 0, all = 0, smooth = 0;
};
AdaptProgress adaptProgress(const Session& session, const TimeSeries& series);

/// Whether frames are smoothed together: where they are made, with a coherence between 0 and infinity.
bool smooths(const AdaptSettings& settings);

/// Frames from one key up to the next, or to the end, whose transfer functions are to be smoothed together.
struct SmoothTask {
    int key = 0;
    std::vector<int> frames; ///< those with a transfer function that is not stale, and no other between
    std::string basis;       ///< fingerprint of all these transfer functions, that at the next key included
};

/// Where smooths(): the first such frames that have all been made and are not smoothed, or from other transfer
/// functions than the present ones. In the order of nextToAdapt(); reads nothing.
std::optional<SmoothTask> nextToSmooth(const Session& session, const TimeSeries& series);

/// The scene of another frame under a given transfer function; everything else is that of `basis`. Where `basis` is of
/// that frame, no data is read. Throws as resolve() does.
Scene sceneAt(const Scene& basis, int frame, const TransferFunction& tf, const JobControl& job = {});

/// What was made for a frame.
struct AdaptedFrame {
    int frame = 0;
    TransferFunction tf;             ///< written for the scene's window, features with their identities
    std::string basis;               ///< that of the task
    std::optional<double> energy;    ///< of a refinement: the movable energy after it
    std::vector<double> vws;         ///< of an optimization: W, per feature
    std::optional<double> objective; ///< of an optimization: F
    int moves = 0;                   ///< of an optimization; iterations of a refinement
    double seconds = 0;              ///< reading included
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
    RefinePriority priorityOf(const Scene& basis, const AdaptTask& task, const JobControl& job);

    std::string m_regionBasis; ///< what m_colors were taken from
    std::vector<RegionColor> m_colors;
    std::map<int, Known> m_models;
};

/// The session with that transfer function in its track.
Session withAdapted(Session session, int frame, AdaptedTf adapted);
/// The session with those that were smoothed beside those that they came from, where these are still there.
Session withSmoothed(Session session, const SmoothedFrames& smoothed);

/// Whether what is made for frames may come out another way.
bool adaptsOtherwise(const Session& a, const Session& b);

/// The transfer function of the session's frame is a key, or is none; other keys stay.
void setTfKey(Session& session);
void removeTfKey(Session& session);
/// It is that of all frames after it, too: keys after it go.
void beginTracksHere(Session& session);
void setTargetKey(Session& session); ///< the targets of the session's frame are its own
/// The nearest frame before (direction −1) or after (1) that has a key of either kind; empty: none.
std::optional<int> keyBeside(const Session& session, int frame, int direction);

/// What a frame shows under a transfer function.
struct FrameFigures {
    int frame = 0;
    std::string file;               ///< see SeriesListing::fileOf()
    double time = 0;                ///< see SeriesFrame
    std::string problem;            ///< why it could not be read: the rest is empty then
    std::vector<double> vws;        ///< W, per feature
    std::vector<double> visibility; ///< FV
    std::vector<double> opacity;    ///< of the peaks
    std::vector<double> targets;    ///< shares
    std::vector<bool> empty;        ///< whether the frame has no voxel of it
    double objective = 0;           ///< F
    std::optional<double> flicker;  ///< mean ΔE to the same frame under the transfer function of neighbourBefore()
    std::optional<int> moves;       ///< that its transfer function took; empty: none was made for it
    double seconds = 0;             ///< likewise, reading included
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
