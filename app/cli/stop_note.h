// What people are to know where a command is stopped.
#pragma once

#include <string>

namespace pellucid::cli {

/// Shown as a note once the command has ended by Ctrl-C; of several the last one.
inline std::string& stopNote() {
    static std::string s_note;
    return s_note;
}

} // namespace pellucid::cli
