#include "base/zeroed_memory.h"

#include <cstdlib>

#include "base/large_pages.h"

namespace pellucid {

void* allocateZeroed(std::size_t bytes) {
    void* memory = std::calloc(bytes > 0 ? bytes : 1, 1);
    if (memory == nullptr) throw std::bad_alloc();
    adviseLargePages(memory, bytes);
    return memory;
}

} // namespace pellucid
