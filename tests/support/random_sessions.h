// Seeded random sessions: everything that a user may have decided, in numbers that no rounding forgives.
#pragma once

#include <cstdint>
#include <string>

#include "session/session.h"
#include "support/random_cases.h"

namespace pellucid::test {

/// A number in [lo, hi] such as people never type and files must keep: tiny (denormal where lo ≤ 0 ≤ hi), of a sum that
/// is off by a bit, or with all its bits used.
double oddNumber(Random& random, double lo, double hi);

/// A valid colour; eight bits do not hold every second one.
Rgb randomColor(Random& random);

/// A valid transfer function of features `first` … that have identities from `first` on; some keys of other programs,
/// which begin with "x-".
TransferFunction randomTf(Random& random, FeatureId first = 1);

/// Session `number`: valid, often incomplete, of data that need not be there. Its features have identities. One in ten
/// is of no data at all.
Session randomSession(std::uint32_t number);

/// Equal, and the features are the same ones too.
bool identical(const Session& a, const Session& b);

} // namespace pellucid::test
