#include <catch2/catch.hpp>

#include <limits>
#include <vector>

#if defined(__linux__)
#include <sys/resource.h>
#endif

#include "base/memory.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

/// Files as the kernel shows them.
class FakeSystem {
public:
    void write(const std::string& path, const std::string& text) const {
        std::filesystem::create_directories(std::filesystem::path(m_folder.path(path)).parent_path());
        m_folder.write(path, text);
    }
    std::uint64_t available() const { return availableMemoryBytes(std::filesystem::path(m_folder.path(""))); }

private:
    TempFolder m_folder;
};

struct LimitedMemory {
    explicit LimitedMemory(std::uint64_t bytes) { setMemoryLimit(bytes); }
    ~LimitedMemory() { setMemoryLimit({}); }
};

} // namespace

TEST_CASE("what the system calls available is available", "[memory]") {
    const FakeSystem system;
    CHECK(system.available() == kUnknown);
    system.write("proc/meminfo", "MemTotal:  8000 kB\nMemFree:   100 kB\nMemAvailable:   3000 kB\nBuffers: 1 kB\n");
    CHECK(system.available() == 3000 * 1024);
}

TEST_CASE("control groups leave what their limits say, the tightest of all decides", "[memory]") {
    const FakeSystem system;
    system.write("proc/meminfo", "MemAvailable: 9000 kB\n");
    SECTION("version 2") {
        system.write("proc/self/cgroup", "0::/outer/inner\n");
        CHECK(system.available() == 9000 * 1024); // no limits to be seen
        system.write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
        system.write("sys/fs/cgroup/outer/inner/memory.current", "100\n");
        CHECK(system.available() == 9000 * 1024);
        system.write("sys/fs/cgroup/outer/memory.max", "5000000\n");
        system.write("sys/fs/cgroup/outer/memory.current", "1000000\n");
        CHECK(system.available() == 4'000'000);
        // Cached files give way.
        system.write("sys/fs/cgroup/outer/memory.stat", "anon 1\ninactive_file 300000\nactive_file 7\n");
        CHECK(system.available() == 4'300'000);
        system.write("sys/fs/cgroup/outer/inner/memory.max", "150\n");
        CHECK(system.available() == 50);
        system.write("sys/fs/cgroup/outer/inner/memory.current", "200\n");
        CHECK(system.available() == 0);
    }
    SECTION("version 1") {
        system.write("proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/job\n0::/\n");
        system.write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "6000000\n");
        system.write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "2500000\n");
        CHECK(system.available() == 3'500'000);
        system.write("sys/fs/cgroup/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 500000\n");
        CHECK(system.available() == 4'000'000);
    }
    SECTION("a container sees its own group as the root") {
        system.write("proc/self/cgroup", "0::/a/path/of/the/host\n");
        system.write("sys/fs/cgroup/memory.max", "3000000\n");
        system.write("sys/fs/cgroup/memory.current", "1000000\n");
        CHECK(system.available() == 2'000'000);
    }
}

TEST_CASE("a limit that the user gives is what counts, less what is used", "[memory]") {
    const LimitedMemory limit(std::uint64_t{1} << 50);
    CHECK(availableMemoryBytes() <= std::uint64_t{1} << 50);
    CHECK(availableMemoryBytes() > std::uint64_t{1} << 49);
    setMemoryLimit(1);
#if defined(__linux__)
    CHECK(availableMemoryBytes() == 0); // more is used already
#else
    CHECK(availableMemoryBytes() <= 1);
#endif
    setMemoryLimit({});
    CHECK(availableMemoryBytes() < std::uint64_t{1} << 49);
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
TEST_CASE("the limit on address space counts", "[memory]") {
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
    rlimit tight = before;
    tight.rlim_cur = rlim_t{1} << 38; // 256 GiB: less than machines may have, more than this process maps
    REQUIRE(setrlimit(RLIMIT_AS, &tight) == 0);
    const std::uint64_t wide = availableMemoryBytes();
    tight.rlim_cur = rlim_t{3} << 30;
    REQUIRE(setrlimit(RLIMIT_AS, &tight) == 0);
    const std::uint64_t narrow = availableMemoryBytes();
    REQUIRE(setrlimit(RLIMIT_AS, &before) == 0);
    CHECK(wide <= std::uint64_t{1} << 38);
    CHECK(narrow < std::uint64_t{3} << 30); // something is mapped already
    CHECK(narrow <= wide);
}
#endif

#if defined(__linux__)
TEST_CASE("memory that is taken counts as used", "[memory]") {
    constexpr std::size_t kTaken = std::size_t{64} << 20;
    const std::uint64_t before = usedMemoryBytes();
    REQUIRE(before > 0);
    const std::vector<char> taken(kTaken, 'x'); // written, so that its pages are there
    CHECK(taken.back() == 'x');
    const std::uint64_t after = usedMemoryBytes();
    CHECK(after >= before + kTaken * 9 / 10);
    CHECK(after <= before + kTaken * 2);
    // Of a limit, what is used is gone.
    const LimitedMemory limit(after + kTaken);
    CHECK(availableMemoryBytes() <= kTaken * 11 / 10);
}
#endif
