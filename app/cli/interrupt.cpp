#include "interrupt.h"

#include <atomic>
#include <csignal>
#include <ctime>
#include <system_error>
#include <thread>

#include <pthread.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "progress.h"

namespace pellucid::cli {

namespace {

std::atomic<int> g_signal{0};

std::stop_source& source() {
    static auto* const g_source = new std::stop_source; // never freed: the watching thread may outlive main()
    return *g_source;
}

sigset_t watchedSignals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    return set;
}

/// Waits for a signal, asks for an orderly stop, and ends the process where that takes longer than a person waits:
/// inside a driver or a compressing writer nobody asks the stop token. A second signal ends it right away.
void watch() {
    const sigset_t set = watchedSignals();
    int signal = 0;
    while (sigwait(&set, &signal) != 0) {
    }
    g_signal = signal;
    source().request_stop();
    const timespec grace{0, 300'000'000};
    sigtimedwait(&set, nullptr, &grace);
    removeUnfinishedFiles();
    clearProgressLine();
    _exit(128 + signal);
}

} // namespace

void installInterrupt() {
    source();
    const sigset_t set = watchedSignals();
    // A shell starts background jobs with SIGINT ignored; we want `kill -INT` to work there too.
    std::signal(SIGINT, SIG_DFL);
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    try {
        std::thread(watch).detach();
    } catch (const std::system_error&) { // no more threads: then a signal ends the program as it ends others
        pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    }
}

std::stop_token interruptToken() { return source().get_token(); }
int interruptStatus() { return g_signal == 0 ? 0 : 128 + g_signal; }

} // namespace pellucid::cli
