// Ranks by MPI: the only place that knows it.
#pragma once

#include <memory>
#include <string>

#include "ranks/communicator.h"

namespace pellucid {

/// The ranks of a program that MPI has started, or of a part of one.
class MpiRanks final : public Communicator {
public:
    /// Begins MPI, which ends with this; one at a time. Throws Error where MPI cannot.
    MpiRanks(int& argc, char**& argv);
    /// In a program that has begun MPI: the ranks of `comm`, which points to an MPI_Comm, with messages of their own.
    explicit MpiRanks(const void* comm);
    /// Where leave() was not called and there are other ranks, the whole program is ended, since they may wait.
    ~MpiRanks() override;
    MpiRanks(const MpiRanks&) = delete;
    MpiRanks& operator=(const MpiRanks&) = delete;

    int rank() const override { return m_rank; }
    int size() const override { return m_size; }
    void await(const Work& meanwhile) override;
    std::vector<RankMessage> exchange(std::vector<RankMessage> messages) override;
    void sum(std::span<double> values) override;
    std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) override;

    /// How many of the ranks run on this one's machine, itself included. Collective.
    int onThisMachine();

    /// Throws Error where ranks run different programs.
    void requireSameProgram();

    /// How a rank's work ended: what it would say, empty where all is well. To be called by every rank once, at the
    /// end: a rank that cannot go on calls it early, and every call of another throws RankLost. Returns on rank 0 what
    /// the first rank with something to say says, with its number where other ranks have nothing to say.
    struct Ending {
        int status = 0;
        std::string message;
    };
    Ending leave(const Ending& mine);

private:
    struct Group;
    void findPlace();
    void requireAll(const Work& meanwhile = {});

    std::unique_ptr<Group> m_group;
    int m_rank = 0, m_size = 1;
    bool m_left = false, m_lost = false;
};

} // namespace pellucid
