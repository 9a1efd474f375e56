// Work that several processes divide.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace pellucid {

/// The bytes of each process, for all, in an order that is the same for all. All processes call it, as often.
using GatherBytes = std::function<std::vector<std::vector<std::byte>>(std::span<const std::byte>)>;

/// Which part of it is this process's: at first all.
struct SharedWork {
    std::size_t part = 0, parts = 1; ///< every parts-th thing, from `part` on
    GatherBytes gather = {};         ///< from the processes in the order of their parts; empty where parts is 1

    bool isMine(std::size_t i) const { return i % parts == part; }
};

/// What make(i) gives for each i in [0, count), for all processes, each of which makes what is its own. Collective:
/// where make() throws, gather() has to tell the others.
std::vector<std::vector<double>> madeTogether(const SharedWork& work, std::size_t count,
                                              const std::function<std::vector<double>(std::size_t)>& make);

} // namespace pellucid
