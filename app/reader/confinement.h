// What is taken from pellucid-reader before it looks at a file, so that nothing in a file can make it do more than
// read.
#pragma once

#include <cstdint>
#include <string>

namespace pellucid::reader {

/// From now on this process can read what lies in `folder`, and what links there lead to, and nothing else; it cannot
/// open a file to write, start a program, talk to another process or to the network. It ends with the process that has
/// started it. Where the system cannot forbid something (Landlock needs Linux 5.13, seccomp x86-64 or ARM64), the rest
/// still holds.
void confineTo(const std::string& folder);

/// Memory that it may take from now on, bytes besides what it has.
void limitMemory(std::uint64_t bytes);

/// Time that it may compute from now on until it is called again: 4 s, and 1 s for each 2 MB of the `bytes` that are
/// read. The process is ended by SIGXCPU then.
void limitTime(std::uint64_t bytes);

} // namespace pellucid::reader
