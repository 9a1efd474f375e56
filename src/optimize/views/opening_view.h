// From where a volume is seen at first (docs/method.md, "The opening view").
#pragma once

#include <optional>

#include "base/job.h"
#include "render/holder.h"
#include "render/view.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// What is drawn of the volume, fitted into the picture, in perspective. A patient is seen as patients are known, from
/// the usual direction, 30° to the left of the front and 20° above it. So is whatever shows no more from elsewhere: of
/// 26 directions around, that one is taken from which most is seen of the feature that is seen least, if that is
/// clearly more, and from below only if it is still more. What the object lies on (findHolder()) is behind it,
/// and Clipping::rest of the view. The third axis of the world is up. The same for any number of threads. Throws
/// Cancelled.
View openingView(const Volume& volume, const TransferFunction& tf, const std::optional<Holder>& holder,
                 const JobControl& job = {});

/// How well a view shows the features: the part that is seen of the one that is seen least, of what would be seen
/// without the others, times the fourth root of the part of the picture in which anything lies, [0,1]. Features that no
/// ray meets do not count.
double shownLeast(const Volume& volume, const TransferFunction& tf, const View& view, const JobControl& job = {});

} // namespace pellucid
