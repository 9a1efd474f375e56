// Which frames of a series need a transfer function made for them (docs/method.md, "Transfer functions over time"),
// told by fingerprints of all that each one depends on. Reads no data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/session.h"
#include "volume/time_series.h"

namespace pellucid {

/// A transfer function that is to be made, from that of the frame before.
struct AdaptTask {
    int frame = 0;
    int key = 0;               ///< the key frame that it goes back to; its own where it is that
    TransferFunction previous; ///< what it starts from: that of the frame before, or the key
    std::string basis;         ///< frameFingerprint() of these
};

/// Text that is the same exactly where a frame's adapted transfer function would be: a hash of the frame's data, their
/// window, the transfer function it starts from, AdaptSettings, and of what its mode depends on: settings of refinement
/// and its profile (where a region or a hue is favoured, the key's transfer function and the colours of several
/// variables, of a region the view and clipping, too), or targets of this frame,
/// limits, settings of optimization and measuring, view, clipping and colours of several variables. Files count by
/// their names and sizes, so that a session can be moved. `session` is any frame's.
std::string frameFingerprint(const Session& session, const TimeSeries& series, int frame,
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

/// What the frames from this key on begin with: what was made for its own frame, where that can be read, else the key.
const TransferFunction& startAtKey(const TfTrack& track, int key);
/// A fingerprint of `tf` and of what that depends on, its `basis`.
std::string fingerprintWith(const TransferFunction& tf, const std::string& basis);

} // namespace pellucid
