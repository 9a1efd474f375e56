// Files that commands are to write: what can be told before the work.
#pragma once

#include <string>

namespace pellucid::cli {

void requireFileName(const std::string& path, const std::string& option); ///< throws UsageError where it is empty
/// Where a file is to be written: throws, before any work is done, where that cannot work.
void checkOutputFile(const std::string& path, const std::string& option);

} // namespace pellucid::cli
