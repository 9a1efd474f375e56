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
        Describe, ///< answered by a ReaderDescription
        Read      ///< answered by a ReaderLayout; the voxels follow once it has been told to go on
    };
    std::string program; ///< that is asked: "pellucid-reader", "pellucid-tiff-reader", …
    Task task = Task::Describe;
    std::string path;  ///< a file or a folder
    std::string array; ///< the series, image or array that is wanted; empty: the largest
    int step = 0;      ///< the time step that is read
};

/// What it says there is.
struct ReaderDescription {
    FileContents contents;
    std::vector<std::string> files; ///< that hold the voxels
};

/// A coarser copy of the voxels that the files have besides.
struct ReaderLevel {
    Int3 dims{1, 1, 1};
    Int3 factors{1, 1, 1}; ///< voxels of the data to one of these, along each axis
    Vec3 spacing{1, 1, 1}, origin{0, 0, 0};
};

/// What it says of the voxels, which it writes box by box: x fastest, without gaps, in this machine's byte order.
struct ReaderLayout {
    FileLayout layout;               ///< but for where the values are
    std::optional<double> missing;   ///< the value that stands for none, as the file says; scaled
    std::vector<ReaderLevel> levels; ///< from fine to coarse
    int layersAtOnce = 1;            ///< layers across z that are stored together
    /// Where given: the values of the step stand in the file that was opened, in the order of layout.bigEndian, in
    /// parts of one size that begin at these bytes. They can be read there, without the reader.
    std::vector<std::uint64_t> inFile;
};

/// What it is to write next.
struct ReaderBox {
    int level = 0;      ///< 0: the voxels themselves; n: those of levels[n − 1]
    VoxelRegion region; ///< in voxels of the level
    int component = 0;  ///< where the axis of components is the last one: the one that is written
};

nlohmann::json jsonOf(const ReaderRequest& request);
nlohmann::json jsonOf(const ReaderDescription& description);
nlohmann::json jsonOf(const ReaderLayout& answer);
nlohmann::json jsonOf(const ReaderBox& box);
nlohmann::json jsonOf(const Error& error);

/// Throw Error where `message` is not what was to come: the other end may be damaged, or in the hands of a file.
ReaderRequest requestIn(const nlohmann::json& message);
ReaderDescription descriptionIn(const nlohmann::json& message);
ReaderLayout layoutIn(const nlohmann::json& message);
ReaderBox boxIn(const nlohmann::json& message);
[[noreturn]] void throwErrorIn(const nlohmann::json& message);

/// Voxels along each axis of a level, 0 being the voxels themselves. Throws FileError where there is no such level.
Int3 dimsOf(const ReaderLayout& answer, int level);
/// Whether each component has its own box, one behind the other: their axis is the last one.
bool componentsAreApart(const FileLayout& layout);
/// Of one voxel in a box.
std::uint64_t bytesPerVoxel(const FileLayout& layout);
/// Of a box. Throws FileError, with `path`, where it does not lie in its level, or has too many to count.
std::uint64_t bytesOf(const ReaderBox& box, const ReaderLayout& answer, const std::string& path);

} // namespace pellucid
