#include "volume/atomic_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <unistd.h>

#include "volume/error.h"

namespace pellucid {

namespace fs = std::filesystem;

void writeAtomically(const std::string& path, const std::function<void(const std::string&)>& write) {
    const fs::path target(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code ec;
    if (!fs::is_directory(folder, ec)) throw FileError("the folder does not exist", folder.string(), "create it first");
    if (fs::is_directory(target, ec)) throw FileError("a folder has this name", path, "choose another name");
    const fs::path temporary =
        folder / ("." + target.stem().string() + ".part" + std::to_string(getpid()) + target.extension().string());
    try {
        write(temporary.string());
        fs::rename(temporary, target, ec);
        if (ec) throw FileError("cannot write the file (" + ec.message() + ")", path, "check permissions and space");
    } catch (...) {
        fs::remove(temporary, ec);
        throw;
    }
}

void writeTextAtomically(const std::string& path, const std::string& text) {
    writeAtomically(path, [&](const std::string& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out << text;
        out.close();
        if (!out) throw FileError("cannot write the file", path, "check permissions and space");
    });
}

std::string readText(const std::string& path) {
    std::error_code ec;
    if (!fs::exists(path, ec)) throw FileError("no such file", path, "check the name");
    if (fs::is_directory(path, ec)) throw FileError("this is a folder, not a file", path, "name a file in it");
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw FileError("cannot read the file", path, "check permissions");
    return text.str();
}

} // namespace pellucid
