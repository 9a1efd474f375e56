// The group of ranks that this process belongs to.
#pragma once

#include "base/shared_work.h"
#include "ranks/communicator.h"

namespace pellucid {

/// Null, as it is at first: the process works alone.
Communicator* ranksOfProcess();
/// Set before any work on them, which they outlive; null: the process works alone again. Of several ranks the first
/// keeps the files that all write (keepWrittenFiles()).
void setRanksOfProcess(Communicator* ranks);

/// While one lives the process is a group of its own: what it reads, measures, draws and writes meanwhile no other rank
/// takes part in. What it reads is there as a whole.
class WorkAlone {
public:
    WorkAlone();
    ~WorkAlone();
    WorkAlone(const WorkAlone&) = delete;
    WorkAlone& operator=(const WorkAlone&) = delete;

private:
    Communicator* m_ranks;
};

/// This process's part of what the group divides; all where it works alone.
SharedWork workOfProcess();

/// Whether ranks divide the frames of series from now on: those that are read are on each rank as a whole, where all
/// have room for that (RankLayout::roomForFrame). At first they do not.
void divideFrames(bool divides);
bool dividesFrames();

} // namespace pellucid
