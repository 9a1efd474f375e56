// How long this process has computed, and those that it has waited for.
#pragma once

#include <sys/resource.h>

/// Seconds of all threads, within the system included.
inline double secondsOfComputing() {
    double seconds = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        getrusage(who, &used);
        for (const timeval& time : {used.ru_utime, used.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}
