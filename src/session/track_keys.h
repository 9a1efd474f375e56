// Key frames of transfer functions and targets, and whether what is made between them may come out another way.
#pragma once

#include <optional>

#include "session/session.h"

namespace pellucid {

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

} // namespace pellucid
