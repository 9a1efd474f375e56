#include "base/zeroed_memory.h"

#include <cstdint>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace pellucid {

namespace {

/// Asks the system for large pages where `memory` has any; where it refuses, they are small.
void adviseLargePages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::uintptr_t kLargePage = std::uintptr_t{1} << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(memory), first = (begin + kLargePage - 1) & ~(kLargePage - 1);
    const auto end = (begin + bytes) & ~(kLargePage - 1);
    if (end > first) static_cast<void>(madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));
#endif
}

} // namespace

void* allocateZeroed(std::size_t bytes) {
    void* memory = std::calloc(bytes > 0 ? bytes : 1, 1);
    if (memory == nullptr) throw std::bad_alloc();
    adviseLargePages(memory, bytes);
    return memory;
}

} // namespace pellucid
