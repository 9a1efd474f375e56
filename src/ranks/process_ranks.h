// The group of ranks that this process belongs to.
#pragma once

#include "ranks/communicator.h"

namespace pellucid {

/// Null, as it is at first: the process works alone.
Communicator* ranksOfProcess();
/// Set once, before any work; outlives it.
void setRanksOfProcess(Communicator* ranks);

} // namespace pellucid
