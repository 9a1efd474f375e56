// Scenes of 3D Slicer (.mrml): the volumes in them, which lie in files of their own.
#include <algorithm>
#include <filesystem>
#include <map>

#include "base/text.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/xml_tags.h"
#include "volume/outside_files.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNodes = 1'000'000, kMostName = 1000;

/// A volume of a scene.
struct SceneVolume {
    std::string name, path;
};

/// The node that stores a volume: "storageNodeRef" in older scenes, else "…;storage:ID;…" among its references.
std::string storageOf(const XmlTag& tag) {
    if (const std::string older = tag.get("storageNodeRef"); !older.empty()) return older;
    const std::string references = tag.get("references");
    constexpr std::string_view kRole = "storage:";
    std::size_t begin = references.starts_with(kRole) ? 0 : references.find(';' + std::string(kRole));
    if (begin == std::string::npos) return {};
    begin = references.find(':', begin) + 1;
    return trimmed(references.substr(begin, references.find_first_of("; ", begin) - begin));
}

std::string fileOf(const std::string& scene, const std::string& named) {
    requireInside(scene, percentDecoded(named));
    const fs::path folder = fs::path(scene).parent_path();
    std::error_code ec;
    const fs::path asItStands = folder / named;
    return (fs::exists(asItStands, ec) ? asItStands : folder / percentDecoded(named)).string();
}

std::vector<SceneVolume> readScene(const std::string& path, const JobControl& job) {
    const std::string head = fileHead(path, kHeadBytes);
    if (describeContent(head) != kMrmlContent) throw notOfFormat("a scene of 3D Slicer", path, head);
    const auto fail = [&](const std::string& what, const std::string& toDo) { return FileError(what, path, toDo); };
    XmlTags tags(path, job);
    XmlTag tag;
    struct Node {
        std::string name, storage;
    };
    std::vector<Node> nodes;
    std::map<std::string, std::string> files; // of storage nodes
    for (std::size_t n = 0; tags.next(tag); ++n) {
        if (n >= kMostNodes) throw fail("there are too many nodes in the scene", "save a smaller one");
        if (!tag.opens) continue;
        if (tag.name.ends_with("Volume") && !storageOf(tag).empty()) nodes.push_back({tag.get("name"), storageOf(tag)});
        if (tag.name.ends_with("Storage") && !tag.get("fileName").empty()) files[tag.get("id")] = tag.get("fileName");
    }
    std::vector<SceneVolume> volumes;
    for (const Node& node : nodes) {
        const auto file = files.find(node.storage);
        if (file == files.end()) continue; // it has not been saved
        if (file->second.size() > kMostName) throw fail("the name of a file is too long", "save the scene again");
        std::string name = printable(node.name.substr(0, 100));
        const auto count = std::ranges::count(volumes, name, &SceneVolume::name);
        if (name.empty() || count > 0) name += (name.empty() ? "volume " : " ") + std::to_string(volumes.size() + 1);
        volumes.push_back({name, fileOf(path, file->second)});
    }
    if (volumes.empty())
        throw fail("the scene has no volumes that have been saved", "save the scene in 3D Slicer with its volumes");
    return volumes;
}

/// `source` for the file of the volume that it names in a scene; of the first one where it names none.
VolumeSource chosenIn(const std::vector<SceneVolume>& volumes, const VolumeSource& source) {
    auto chosen = volumes.begin();
    if (!source.array.empty()) chosen = std::ranges::find(volumes, source.array, &SceneVolume::name);
    if (chosen == volumes.end())
        throw UsageError("there is no volume " + inQuotes(source.array), source.path,
                         "it has " + joined(volumes, ", ", [](const SceneVolume& v) { return inQuotes(v.name); }));
    // By its content, too: that tells the format, and a scene could name itself by another suffix.
    if (lowerCase(chosen->path).ends_with(".mrml") || contentOf(chosen->path) == kMrmlContent)
        throw FileError("the scene names another scene as a volume", source.path, "save it again");
    VolumeSource file = source;
    file.path = chosen->path;
    file.array.clear();
    return file;
}

FileContents describe(const VolumeSource& source, const JobControl& job) {
    const std::vector<SceneVolume> volumes = readScene(source.path, job);
    const VolumeSource file = chosenIn(volumes, source);
    FileContents contents = contentsOf(file, job);
    contents.arrays.clear();
    contents.details.clear();
    for (const SceneVolume& volume : volumes) {
        contents.arrays.push_back(volume.name);
        contents.details.push_back(printable(fs::path(volume.path).filename().string()));
        if (volume.path == file.path) contents.array = volume.name;
    }
    return contents;
}

Volume read(const VolumeSource& source, const JobControl& job) {
    const std::vector<SceneVolume> volumes = readScene(source.path, job);
    VolumeSource file = chosenIn(volumes, source);
    file.range.reset(); // who reads the scene applies both
    file.axes.reset();
    Volume volume = loadVolume(file, job);
    if (volumes.size() > 1 && source.array.empty())
        volume.notices.push_back("volume " + inQuotes(volumes.front().name) + " of " + std::to_string(volumes.size()) +
                                 " in the scene is shown");
    return volume;
}

std::vector<std::string> filesOfScene(const std::string& path) {
    std::vector<std::string> files;
    for (const SceneVolume& volume : readScene(path, {})) files.push_back(volume.path);
    return files;
}

} // namespace

VolumeFormat mrmlFormat() {
    VolumeFormat format{"scene of 3D Slicer", {".mrml"}, describe, read, filesOfScene, kMrmlContent};
    format.holdsSeveral = true;
    return format;
}

} // namespace pellucid
