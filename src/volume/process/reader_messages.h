// What this program and pellucid-reader say to each other: one JSON text a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "volume/formats/samples.h"

namespace pellucid {

/// What pellucid-reader is to do; the first line that it is told.
struct ReaderRequest {
    enum class Task {
        Describe, ///< answered by a FileContents
        List,     ///< answered by the names of the files that hold the voxels
        Read      ///< answered by a ReaderLayout; the voxels follow once it has been told to go on
    };
    std::string program; ///< that is asked: "pellucid-reader", "pellucid-image-reader" or "pellucid-array-reader"
    Task task = Task::Describe;
    std::string path;        ///< a file or a folder
    std::string array;       ///< the series or array that is wanted; empty: the largest
    int step = 0;            ///< the time step that is read
    bool middleOnly = false; ///< of its slices only the one in the middle
};

/// What it says of the voxels that it is about to write: x fastest, without gaps, in this machine's byte order.
struct ReaderLayout {
    FileLayout layout;             ///< but for where the values are
    std::optional<double> missing; ///< the value that stands for none, as the file says; scaled
};

nlohmann::json jsonOf(const ReaderRequest& request);
nlohmann::json jsonOf(const FileContents& contents);
nlohmann::json jsonOf(const ReaderLayout& answer);
nlohmann::json jsonOf(const Error& error);

/// Throw Error where `message` is not what was to come: the other end may be damaged, or in the hands of a file.
ReaderRequest requestIn(const nlohmann::json& message);
FileContents contentsIn(const nlohmann::json& message);
ReaderLayout layoutIn(const nlohmann::json& message);
std::vector<std::string> filesIn(const nlohmann::json& message);
[[noreturn]] void throwErrorIn(const nlohmann::json& message);

/// Of the voxels that a layout announces. Throws FileError, with `path`, where they are too many to count.
std::uint64_t bytesOf(const FileLayout& layout, const std::string& path);

} // namespace pellucid
