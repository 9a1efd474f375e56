// Our own mistakes stop here, with the place; PELLUCID_DCHECK guards inner loops and vanishes in release builds.
#pragma once

#include <cstdio>
#include <cstdlib>

#define PELLUCID_CHECK(condition)                                                                                      \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition);                         \
            std::abort();                                                                                              \
        }                                                                                                              \
    } while (false)

#ifdef NDEBUG
#define PELLUCID_DCHECK(condition) static_cast<void>(0)
#else
#define PELLUCID_DCHECK(condition) PELLUCID_CHECK(condition)
#endif
