// Which part of divided work is this process's.
#pragma once

#include "base/shared_work.h"

namespace pellucid {

/// That of one of several processes that do the same; all where this is the only one. Things that each of them has as a
/// whole can be divided so.
SharedWork dividedWork();

} // namespace pellucid
