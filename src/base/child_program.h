// Another program, run and waited for.
#pragma once

#include <csignal>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace pellucid {

struct ChildRun {
    std::filesystem::path program; ///< absolute
    std::vector<std::string> words;
    std::filesystem::path folder = {}; ///< it works there; empty: where this program does
    std::filesystem::path out = {};    ///< its standard output; empty: thrown away
    bool talks = false;                ///< people see what it says, on our standard error, in place of all this
    int stopBy = SIGTERM;              ///< the signal that stops it
};

struct ChildEnd {
    int status = 0;    ///< exit status; 128 + the signal's number where a signal ended it
    std::string error; ///< what it said on standard error; empty where it talks
};

/// Throws Error where it cannot be started or `out` cannot be written; Cancelled, once it has gone, where `stop` was
/// requested meanwhile.
ChildEnd runChild(const ChildRun& run, const std::stop_token& stop);

} // namespace pellucid
