#include "output_files.h"

#include <filesystem>

#include <unistd.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "output.h"

namespace pellucid::cli {

namespace fs = std::filesystem;

namespace {

/// One file may have many names: links, "./" and "../" before it. Only regular files are overwritten; a terminal may
/// well be both ends of a command.
bool isSameFile(const std::string& output, const std::string& input) {
    std::error_code ec;
    return fs::is_regular_file(output, ec) && fs::equivalent(output, input, ec);
}

void requireNoInput(const std::string& output, std::span<const std::string> inputs) {
    for (const std::string& input : inputs)
        if (isSameFile(output, input))
            throw UsageError("the output would overwrite the input",
                             output == input ? output : output + ", which is " + input, "choose another name");
}

} // namespace

std::vector<std::string> inputFiles(const SceneOptions& options) {
    std::vector<std::string> notices;
    const SceneInputs inputs = inputsOf(options, {}, notices);
    std::vector<std::string> files = filesOf(inputs.session.variable().source);
    if (const GroundView& ground = *inputs.session.ground; !ground.path.empty()) {
        VolumeSource source;
        source.path = ground.path;
        source.raw = ground.raw;
        for (const std::string& file : filesOf(source)) files.push_back(file);
    }
    for (const auto& file : {options.session.file, options.tf.spec, options.camera.file})
        if (file) files.push_back(*file);
    return files;
}

void requireFileName(const std::string& path, const std::string& option) {
    if (path.empty()) throw UsageError("the file name is empty", option, "name the file to write");
}

void checkOutputFile(const std::string& path, const std::string& option, std::span<const std::string> inputs) {
    requireFileName(path, option);
    requireWritable(path);
    requireNoInput(path, inputs);
}

void checkOutputFolder(const std::string& path, const std::string& option, std::span<const std::string> fileNames,
                       std::span<const std::string> inputs) {
    if (path.empty()) throw UsageError("the folder name is empty", option, "name the folder to write to");
    std::error_code ec;
    if (fs::is_directory(path, ec)) {
        for (const std::string& name : fileNames) checkOutputFile((fs::path(path) / name).string(), option, inputs);
        return;
    }
    const fs::path folder = fs::path(path).has_filename() ? fs::path(path) : fs::path(path).parent_path();
    if (fs::exists(fs::symlink_status(folder, ec))) // a link that leads nowhere too
        throw FileError("a file has the folder's name", path, "choose another name");
    requireWritable(folder.string());
}

void writeCamera(const Camera& camera, const std::string& path) {
    writeTextAtomically(path, jsonText(Json(jsonFromCamera(camera))) + "\n");
}

} // namespace pellucid::cli
