// --session: everything that is not said otherwise comes from a saved session.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "session/session_json.h"

namespace pellucid::cli {

struct SessionOptions {
    std::optional<std::string> file;

    void add(CLI::App& app);
    /// What the file holds; an empty session without one. Throws Error where it cannot be read.
    SessionFile read() const;
};

} // namespace pellucid::cli
