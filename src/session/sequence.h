// What window and command line do alike for a series whose transfer functions follow its frames: the next frame that
// lacks one, smoothing, and frames that turn out to be broken.
#pragma once

#include <functional>
#include <optional>

#include "session/frame_adapter.h"

namespace pellucid {

/// Makes one thing after the other. Keeps what frames share; used by one thread at a time.
class SequenceMaker {
public:
    /// What came of one call.
    struct Step {
        int firstStale = -1; ///< frame of nextToAdapt(); −1: none
        std::optional<AdaptedFrame> made;
        std::optional<SmoothedFrames> smoothed;
        bool passedOver = false; ///< a frame is broken, which the series knows now
        bool goesOn() const { return made || smoothed || passedOver; }
    };
    /// The transfer function of the first frame of `basis.session` that lacks one (nextToAdapt()). Where none does and
    /// `smoothing` is given, what is to be smoothed (nextToSmooth()), which reports its progress to that. A frame whose
    /// files cannot be read is passed over. `begins` is told the frame before it is read. Throws Cancelled, and Error
    /// where the fault is not the frame's.
    Step next(const Scene& basis, const JobControl& job, const JobControl* smoothing = nullptr,
              const std::function<void(int frame)>& begins = {});

    FrameAdapter& adapter() { return m_adapter; }
    Workspace& workspace() { return m_workspace; }

private:
    Workspace m_workspace;
    FrameAdapter m_adapter;
};

/// The session with what the step has made.
Session withStep(Session session, const SequenceMaker::Step& step);

/// Notes in the series that a frame cannot be read. Its own data may be sound where those of another variable are not.
void passOver(TimeSeries& series, int frame, const FileError& error);

/// The session with `tf` as the key of its frame, and without those before it: for who begins there. Throws UsageError
/// where another key has other features; `where` is what brought the keys along.
Session beginningHere(Session session, const TransferFunction& tf, const std::string& where);

} // namespace pellucid
