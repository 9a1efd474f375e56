// What open_files and open_foreign have in common: paths come in, an answer to each goes out.
//
// Standard input has the path of a file or folder in each line; standard output answers each with one line of JSON:
//     {"read": true, …}
//     {"read": false, "error": "WHAT, WHERE, WHAT TO DO", …}
// and in both "cpu", the seconds of computing of this process and of those that it waited for, and "heap_mib", the most
// that it had allocated at once for this file (-1 without the address sanitizer). A crash, and a finding of a
// sanitizer, end it: it was the file that has no answer.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <new>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "computing_time.h"

#ifdef __SANITIZE_ADDRESS__
extern "C" { // of the runtime of sanitizers; GCC 12 has no header that declares them
int __sanitizer_install_malloc_and_free_hooks(void (*added)(const volatile void*, std::size_t),
                                              void (*removed)(const volatile void*));
std::size_t __sanitizer_get_allocated_size(const volatile void* at);
}
#endif

namespace pellucid::test {

/// The heap as the address sanitizer sees it.
class HeapWatch {
public:
    /// From now on.
    static void begin() {
#ifdef __SANITIZE_ADDRESS__
        static const int s_installed = __sanitizer_install_malloc_and_free_hooks(added, removed);
        static_cast<void>(s_installed);
        s_now = s_most = 0;
#endif
    }
    static double mostMib() {
#ifdef __SANITIZE_ADDRESS__
        return static_cast<double>(s_most.load()) / 1048576.0;
#else
        return -1;
#endif
    }

private:
#ifdef __SANITIZE_ADDRESS__
    static void added(const volatile void*, std::size_t bytes) {
        const auto now = s_now += static_cast<std::int64_t>(bytes);
        for (auto most = s_most.load(); now > most && !s_most.compare_exchange_weak(most, now);) {
        }
    }
    static void removed(const volatile void* at) {
        if (at != nullptr) s_now -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(at));
    }
#endif
    static inline std::atomic<std::int64_t> s_now{0}, s_most{0};
};

template <class Open>
nlohmann::json answerTo(const std::string& path, const Open& open) {
    HeapWatch::begin();
    const double before = secondsOfComputing();
    nlohmann::json answer;
    try {
        answer = open(path);
        answer["read"] = true;
    } catch (const Error& e) {
        answer = {{"read", false}, {"error", e.what()}};
    } catch (const std::bad_alloc&) {
        answer = {{"read", false}, {"error", "there is not enough memory, " + path}}; // as the program says it
    }
    answer["heap_mib"] = HeapWatch::mostMib();
    answer["cpu"] = secondsOfComputing() - before;
    return answer;
}

/// Opens what comes in by open(path), which says what it has read.
template <class Open>
void answerAll(const Open& open) {
    for (std::string path; std::getline(std::cin, path);)
        std::cout << answerTo(path, open).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

} // namespace pellucid::test
