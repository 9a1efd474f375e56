#include "ranks/process_ranks.h"

namespace pellucid {

namespace {
Communicator* g_ranks = nullptr;
}

Communicator* ranksOfProcess() { return g_ranks; }
void setRanksOfProcess(Communicator* ranks) { g_ranks = ranks; }

} // namespace pellucid
