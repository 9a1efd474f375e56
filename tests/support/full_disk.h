// A disk that fills up.
#pragma once

#include <csignal>
#include <cstddef>

#include <sys/resource.h>

namespace pellucid::test {

/// While it lives, no file of this process grows beyond `mostBytes`: writing more fails as on a full disk.
class FullDisk {
public:
    explicit FullDisk(std::size_t mostBytes) : m_handler(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &m_before);
        const rlimit tight{mostBytes, m_before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &tight);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &m_before);
        std::signal(SIGXFSZ, m_handler);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

private:
    rlimit m_before{};
    void (*m_handler)(int);
};

} // namespace pellucid::test
