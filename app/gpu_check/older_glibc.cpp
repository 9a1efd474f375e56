// Three functions that glibc has had since 2.35 and 2.36, written with what 2.34 has, so that a program built on Debian
// 12 runs where the C library is a little older. Hidden: no library that a driver brings along may find them.
#include <cstddef>

#include <dlfcn.h>
#include <link.h>
#include <sys/random.h>

#if defined(__x86_64__) && defined(__GLIBC__)

namespace {

struct Search {
    ElfW(Addr) address;
    dl_find_object* result;
};

/// Called per loaded object: whether the address lies in it, and where its table for exceptions is.
int look(dl_phdr_info* object, std::size_t, void* data) {
    auto& search = *static_cast<Search*>(data);
    ElfW(Addr) start = 0, end = 0, exceptions = 0;
    for (int i = 0; i < object->dlpi_phnum; ++i) {
        const ElfW(Phdr)& header = object->dlpi_phdr[i];
        const ElfW(Addr) at = object->dlpi_addr + header.p_vaddr;
        if (header.p_type == PT_LOAD && search.address >= at && search.address < at + header.p_memsz) {
            start = at;
            end = at + header.p_memsz;
        }
        if (header.p_type == PT_GNU_EH_FRAME) exceptions = at;
    }
    if (start == 0 || exceptions == 0) return 0;
    *search.result = {};
    search.result->dlfo_map_start = reinterpret_cast<void*>(start); // of the segment; who unwinds asks no more
    search.result->dlfo_map_end = reinterpret_cast<void*>(end);
    search.result->dlfo_eh_frame = reinterpret_cast<void*>(exceptions);
    return 1;
}

} // namespace

extern "C" {

#define PELLUCID_HIDDEN __attribute__((visibility("hidden")))

/// For unwinding the stack when an exception is thrown. 2.35.
PELLUCID_HIDDEN int _dl_find_object(void* address, dl_find_object* result) noexcept {
    Search search{reinterpret_cast<ElfW(Addr)>(address), result};
    return dl_iterate_phdr(look, &search) == 1 ? 0 : -1;
}

/// For std::random_device. 2.36.
PELLUCID_HIDDEN unsigned arc4random() noexcept {
    unsigned value = 0;
    while (getrandom(&value, sizeof value, 0) != static_cast<ssize_t>(sizeof value)) {
    }
    return value;
}

/// 2.35 has a new one, which does not set errno. The linker leads calls of hypot() here (--wrap).
double pellucidOlderHypot(double x, double y);
__asm__(".symver pellucidOlderHypot, hypot@GLIBC_2.2.5");
PELLUCID_HIDDEN double __wrap_hypot(double x, double y) { return pellucidOlderHypot(x, y); }

} // extern "C"

#endif
