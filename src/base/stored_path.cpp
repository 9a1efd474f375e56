#include "base/stored_path.h"

#include <system_error>

namespace pellucid {

namespace fs = std::filesystem;

std::string relativeTo(const std::string& folder, const std::string& path) {
    std::error_code ec;
    const fs::path absolute = fs::absolute(path, ec);
    if (ec) return path;
    // As they are written: who reads puts both together again, whatever links they lead through.
    const fs::path base = fs::absolute(folder.empty() ? "." : folder, ec).lexically_normal();
    const fs::path relative = absolute.lexically_normal().lexically_proximate(base);
    return (ec || relative.empty() ? absolute : relative).generic_string();
}

std::string foundPath(const fs::path& stored, const std::string& folder) {
    if (stored.is_absolute()) return stored.string();
    const std::string path = (fs::path(folder) / stored).lexically_normal().string();
    std::error_code ec;
    if (fs::exists(path, ec)) return path;
    // The folder may have been reached through a link this time.
    const fs::path real = fs::canonical(folder.empty() ? "." : folder, ec);
    const std::string other = ec ? path : (real / stored).lexically_normal().string();
    return fs::exists(other, ec) ? other : path;
}

} // namespace pellucid
