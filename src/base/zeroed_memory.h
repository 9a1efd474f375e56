// Zeroed memory for large arrays, in large pages.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace pellucid {

/// `bytes` of zeros, as the system hands them out: pages are first touched by the threads that fill them, not by one
/// thread that clears them. Large arrays get large pages where the system has them: touching memory for the first time
/// is most of what it takes to fill it, and large pages make that a few times cheaper. Freed by std::free. Throws
/// std::bad_alloc.
void* allocateZeroed(std::size_t bytes);

template <class T>
struct ZeroedAllocator {
    using value_type = T;
    ZeroedAllocator() = default;
    template <class U>
    ZeroedAllocator(const ZeroedAllocator<U>&) noexcept {}
    T* allocate(std::size_t count) {
        if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
        return static_cast<T*>(allocateZeroed(count * sizeof(T)));
    }
    void deallocate(T* memory, std::size_t) noexcept { std::free(memory); }
    void construct(T*) noexcept {} // it is 0 already
    template <class... Arguments>
    void construct(T* at, Arguments&&... arguments) {
        ::new (static_cast<void*>(at)) T(std::forward<Arguments>(arguments)...);
    }
    bool operator==(const ZeroedAllocator&) const = default;
};

/// Made once in its final size: growing one would not clear what is reused.
template <class T>
using ZeroedVector = std::vector<T, ZeroedAllocator<T>>;

} // namespace pellucid
