// Runs the real pellucid-cli in a folder of its own and catches what it says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace pellucid::test {

struct Outcome {
    int status = -1; ///< exit status; −signal where one ended the process
    std::string out, err;
};

using Words = std::vector<std::string>; ///< arguments
inline Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// A new empty folder, removed at the end; commands run in it.
class Workshop {
public:
    Workshop();
    ~Workshop();
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    Outcome run(const std::vector<std::string>& arguments) const;
    /// Runs it with a limit on the size of files: what it writes beyond fails as on a full disk.
    Outcome runWithFilesUpTo(std::size_t mostBytes, const std::vector<std::string>& arguments) const;
    /// Runs with --json, requires status 0 and nothing on stderr, and reads the object.
    nlohmann::json json(std::vector<std::string> arguments) const;
    /// The same where there may be notes on stderr.
    nlohmann::json jsonAndNotes(std::vector<std::string> arguments) const;

    std::filesystem::path path(const std::string& name) const { return m_folder / name; }
    void write(const std::string& name, const std::string& bytes) const;
    std::string read(const std::string& name) const;
    bool has(const std::string& name) const { return std::filesystem::exists(path(name)); }
    /// Names of everything in the folder, hidden ones too, sorted.
    std::vector<std::string> list() const;

private:
    std::filesystem::path m_folder;
};

/// A pellucid-cli that is still running, for signals.
class Running {
public:
    Running(const Workshop& workshop, const std::vector<std::string>& arguments,
            std::optional<std::size_t> mostFileBytes = {});
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    /// Waits until stderr holds `text`; false where the process ends before.
    bool waitForError(const std::string& text);
    void signal(int number) const;
    Outcome finish();

private:
    bool reap(bool wait);
    std::filesystem::path m_capture;
    pid_t m_pid = -1;
    int m_waitStatus = 0;
    bool m_ended = false;
};

} // namespace pellucid::test
