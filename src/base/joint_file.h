// Output files that several processes write together, whole or absent like those of atomic_file.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "base/shared_work.h"

namespace pellucid {

/// A file while it is being written. What writeAt() has taken has reached the system, or FileError was thrown.
class JointFile {
public:
    void writeAt(std::uint64_t offset, const void* data, std::size_t bytes);

    JointFile(const JointFile&) = delete;
    JointFile& operator=(const JointFile&) = delete;

private:
    friend void writeJointly(const std::string& path, std::uint64_t bytes, const GatherBytes& gather,
                             const std::function<void(JointFile&)>& write);
    explicit JointFile(std::string path) : m_path(std::move(path)) {}
    ~JointFile();

    int m_descriptor = -1; ///< −1: closed
    std::string m_path;
};

/// A file of `bytes`, into which each process writes its own places. The process that keeps what is written
/// (keepWrittenFiles()) makes it beside `path` and, when all are done and their bytes are on the disk, renames it;
/// where any of them fails it removes it. Collective: throws FileError as writeAtomically() does, where a process
/// cannot see the file that another one has made, and for devices and pipes; what gather() throws goes on.
void writeJointly(const std::string& path, std::uint64_t bytes, const GatherBytes& gather,
                  const std::function<void(JointFile&)>& write);

} // namespace pellucid
