// The group of ranks that this process belongs to.
#pragma once

#include "ranks/communicator.h"

namespace pellucid {

/// Null, as it is at first: the process works alone.
Communicator* ranksOfProcess();
/// Set before any work on them, which they outlive; null: the process works alone again.
void setRanksOfProcess(Communicator* ranks);

} // namespace pellucid
