// What ranks say to each other: the interface; src/ranks/mpi has the one by MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <vector>

#include "base/byte_stream.h"
#include "base/error.h"

namespace pellucid {

/// Another rank cannot go on. What is wrong is said by that rank alone. No Error: nothing that passes over a fault of a
/// file may pass over this.
class RankLost : public std::runtime_error {
public:
    RankLost() : std::runtime_error("another rank cannot go on") {}
};

/// Bytes for a rank, or from one.
struct RankMessage {
    int rank = 0;
    std::vector<std::byte> bytes;
};

/// What has been sent, for those who compare it with a model.
struct Traffic {
    std::uint64_t bytes = 0;    ///< to other ranks
    std::uint64_t messages = 0; ///< likewise
    std::uint64_t rounds = 0;   ///< of messages that wait for each other
};

/// A group of ranks that run the same program on different blocks. All calls are collective: every rank makes the same
/// ones in the same order. Calls throw RankLost where another rank cannot go on.
class Communicator {
public:
    virtual ~Communicator() = default;
    virtual int rank() const = 0; ///< of this one, in [0, size())
    virtual int size() const = 0;

    /// A little work: false where there is none left.
    using Work = std::function<bool()>;
    /// Waits for all ranks to come here, and does as much of the work as there is time for. What it throws is thrown
    /// once all are here.
    virtual void await(const Work& meanwhile) = 0;
    /// Hands over messages, at most one for each rank; returns those for this rank, by ascending rank of the sender.
    virtual std::vector<RankMessage> exchange(std::vector<RankMessage> messages) = 0;
    /// The elements of all ranks added up, in an order that depends on size() alone: all get the same bits.
    virtual void sum(std::span<double> values) = 0;
    /// Those of each rank, in their order, for all.
    virtual std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) = 0;

    const Traffic& traffic() const { return m_traffic; }

protected:
    Traffic m_traffic;
};

/// The value of each rank.
template <class T>
std::vector<T> gatherValues(Communicator& ranks, const T& value) {
    std::vector<T> all;
    for (const auto& bytes : ranks.gather(std::as_bytes(std::span(&value, 1))))
        all.push_back(ByteReader(bytes).take<T>());
    return all;
}

} // namespace pellucid
