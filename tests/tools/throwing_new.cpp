// The address sanitizer of GCC 12 ends the program where memory cannot be had, which C++ has an exception for. With
// these, of open_files and open_foreign, the exception is thrown, in libraries, too.
#ifdef __SANITIZE_ADDRESS__

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

void* allocated(std::size_t bytes) {
    if (void* const at = std::malloc(bytes > 0 ? bytes : 1)) return at; // the sanitizer's
    throw std::bad_alloc();
}

} // namespace

void* operator new(std::size_t bytes) { return allocated(bytes); }
void* operator new[](std::size_t bytes) { return allocated(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return std::malloc(bytes > 0 ? bytes : 1); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return std::malloc(bytes > 0 ? bytes : 1); }
void operator delete(void* at) noexcept { std::free(at); }
void operator delete[](void* at) noexcept { std::free(at); }
void operator delete(void* at, std::size_t) noexcept { std::free(at); }
void operator delete[](void* at, std::size_t) noexcept { std::free(at); }
void operator delete(void* at, const std::nothrow_t&) noexcept { std::free(at); }
void operator delete[](void* at, const std::nothrow_t&) noexcept { std::free(at); }

#endif
