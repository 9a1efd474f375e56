// All files of one call, what it reads and what it writes: no output is one of the inputs, and no two are one file.
//
// Nobody has to remember to ask. An output is an option made by addOutputFile() or addOutputFolder(); an input is what
// the session names (inputsOf()), and whatever is opened. watchCallFiles() sees every file that is read or written
// besides: one that no option announced is checked then, before it is opened.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "parse.h"
#include "render/camera.h"

namespace pellucid::cli {

/// Begins to watch; main() does, before it parses.
void watchCallFiles();

/// Files are the same whatever name leads there: links, hard links, "./" and "../". Only regular files count, and names
/// that nothing has yet: a terminal may well be both ends of a command. From any thread.
///
/// Throws UsageError where the file is announced as an output.
void addInputFile(const std::string& path);
/// Throws UsageError where it is an input or another output, FileError where it cannot be written. `option` says in
/// messages what asked for it.
void addOutputFile(const std::string& path, const std::string& option);
/// The same of a file in the folder of an addOutputFolder().
void addOutputFile(const std::string& folder, const std::string& file, const std::string& option);

/// The name of a folder to write to. Throws UsageError and FileError where it cannot be one.
std::string parseOutputFolder(const std::string& path, const std::string& option);

/// Adds an option that names a file to be written, and stores the name in `target` (a string, maybe an optional one),
/// which outlives the parsing. The file is announced when the command line is read; before that `check` may refuse the
/// name, such as its suffix.
template <class T>
CLI::Option* addOutputFile(CLI::App& app, const std::string& name, T& target, const std::string& help,
                           const std::function<void(const std::string& path)>& check = {}) {
    return addValue(
        app, name, "FILE", target,
        [check](const std::string& path, const std::string& option) {
            if (path.empty()) throw UsageError("the file name is empty", option, "name the file to write");
            if (check) check(path);
            addOutputFile(path, option);
            return path;
        },
        help);
}
/// The same of a folder, which may be missing: its files are announced as soon as their names are known.
template <class T>
CLI::Option* addOutputFolder(CLI::App& app, const std::string& name, T& target, const std::string& help) {
    return addValue(app, name, "DIR", target, parseOutputFolder, help);
}

/// A folder that goes again where nothing could be written into it.
class OutputFolder {
public:
    /// On ranks it is collective: whichever of them makes it, it is new for all.
    explicit OutputFolder(const std::string& path);
    ~OutputFolder() {
        std::error_code ec;
        if (m_isNew) std::filesystem::remove(m_path, ec); // an empty one only
    }
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

private:
    std::filesystem::path m_path;
    bool m_isNew = false;
};

/// What files of transfer functions may be (writeTfFile()), for the help of options.
inline constexpr const char* kTfFileHelp = ": *.tf.json, or *.paraview.json for ParaView to import";

/// *.camera.json. Throws FileError.
void writeCamera(const Camera& camera, const std::string& path);

} // namespace pellucid::cli
