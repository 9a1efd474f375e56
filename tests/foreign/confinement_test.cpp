// What a process cannot do any more that has confined itself: each attempt in a process of its own.
#include <catch2/catch.hpp>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <thread>

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "confinement.h"
#include "support/temp_folder.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// Whether `attempt` succeeds in a process that has been confined to `folder`.
bool succeeds(const std::string& folder, const std::function<bool()>& attempt) {
    const pid_t child = fork();
    if (child == 0) {
        reader::confineTo(folder);
        _exit(attempt() ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool opens(const std::string& path, int how) { return open(path.c_str(), how, 0600) >= 0; }

} // namespace

TEST_CASE("a confined process reads its folder, and reaches nothing else", "[confinement]") {
    const TempFolder folder, other;
    const std::string own = folder.write("own", "x"), beyond = other.write("beyond", "x");
    const std::string linked = other.write("linked", "x");
    std::filesystem::create_symlink(linked, folder.path("link"));
    const std::string in = std::filesystem::path(own).parent_path().string();
    CHECK(succeeds(in, [&] { return opens(own, O_RDONLY); }));
    CHECK(succeeds(in, [&] { return opens(folder.path("link"), O_RDONLY); }));
    CHECK_FALSE(succeeds(in, [&] { return socket(AF_INET, SOCK_STREAM, 0) >= 0; }));
    CHECK_FALSE(succeeds(in, [&] { return fork() >= 0; }));
    CHECK(succeeds(in, [&] { // a thread is no process
        bool hasRun = false;
        std::thread([&] { hasRun = true; }).join();
        return hasRun;
    }));
    CHECK_FALSE(succeeds(in, [&] { return unlink(own.c_str()) == 0; }));
    CHECK_FALSE(succeeds(in, [&] { return kill(getppid(), 0) == 0; }));
    CHECK_FALSE(succeeds(in, [&] {
        const char* const words[] = {"/bin/true", nullptr};
        execv(words[0], const_cast<char**>(words));
        return false;
    }));
    if (syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 1) {
        WARN("SKIPPED: this system has no Landlock");
        return;
    }
    CHECK_FALSE(succeeds(in, [&] { return opens(beyond, O_RDONLY); }));
    CHECK_FALSE(succeeds(in, [&] { return opens("/etc/passwd", O_RDONLY); }));
    CHECK_FALSE(succeeds(in, [&] { return opens(own, O_WRONLY); }));
    CHECK_FALSE(succeeds(in, [&] { return opens(folder.path("new"), O_WRONLY | O_CREAT); }));
}

TEST_CASE("a confined process gets no more memory and time than it is given", "[confinement]") {
    const TempFolder folder;
    const std::string in = std::filesystem::path(folder.path("x")).parent_path().string();
    const auto takes = [](std::size_t bytes) {
        void* const memory = std::malloc(bytes);
        std::free(memory);
        return memory != nullptr;
    };
    CHECK(succeeds(in, [&] {
        reader::limitMemory(256u << 20);
        return takes(200u << 20);
    }));
    CHECK_FALSE(succeeds(in, [&] {
        reader::limitMemory(256u << 20);
        return takes(300u << 20);
    }));
    CHECK_FALSE(succeeds(in, [&] {
        reader::limitTime(0);
        while (clock() >= 0) { // computes, and never ends by itself
        }
        return true;
    }));
}
