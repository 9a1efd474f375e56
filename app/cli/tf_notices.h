// What is to be said of transfer functions of other programs, read or written, among the other notices of a command.
#pragma once

#include <string>
#include <vector>

namespace pellucid::cli {

/// Adds what writeTfFile() says is lost.
inline void addTo(std::vector<std::string>& notices, const std::vector<std::string>& losses) {
    notices.insert(notices.end(), losses.begin(), losses.end());
}

} // namespace pellucid::cli
