// Scenes of 3D Slicer (.mrml): the volumes in them, which lie in files of their own.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/text.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/formats/xml_tags.h"
#include "volume/outside_files.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNodes = 1'000'000, kMostName = 1000;

/// From one world to another, both the patient's: linear·x + shift.
struct Placement {
    Mat3 linear{1};
    Vec3 shift{0, 0, 0};
};

/// A volume of a scene.
struct SceneVolume {
    std::string name, path;
    std::optional<Placement> moved; ///< by the transforms that it is under; empty: it is under none …
    std::string unmoved;            ///< … or this one, which is not known, or bends
};

/// A transform of a scene.
struct SceneTransform {
    std::string name, parent;
    std::optional<Placement> toParent; ///< empty: it bends, or its matrix is in another file
};

/// The node that a node refers to as its `role`: "storageNodeRef" in older scenes, else "…;storage:ID;…".
std::string referenceOf(const XmlTag& tag, const std::string& role) {
    if (const std::string older = tag.get(role + "NodeRef"); !older.empty()) return older;
    const std::string references = tag.get("references"), named = role + ":";
    std::size_t begin = references.starts_with(named) ? 0 : references.find(';' + named);
    if (begin == std::string::npos) return {};
    begin = references.find(':', begin) + 1;
    return trimmed(references.substr(begin, references.find_first_of("; ", begin) - begin));
}

/// Scenes have sixteen numbers, row by row, in a world whose x and y go to the right and to the front: ours go to the
/// left and to the back.
std::optional<Placement> placementIn(const std::string& matrix) {
    constexpr double kFlip[] = {-1, -1, 1};
    const std::vector<std::string> words = splitWords(matrix);
    if (words.size() != 16) return {};
    Placement placement;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const double number = numberIn(words[static_cast<std::size_t>(4 * row + column)]);
            if (!std::isfinite(number)) return {};
            if (column == 3)
                placement.shift[row] = kFlip[row] * number;
            else
                placement.linear[column][row] = kFlip[row] * kFlip[column] * number;
        }
    return placement;
}

/// Puts `volume` under the transform `id` and those that this one is under.
void placeUnder(SceneVolume& volume, std::string id, const std::map<std::string, SceneTransform>& transforms) {
    constexpr int kMost = 100; // they may be under each other
    Placement all;
    for (int n = 0; !id.empty(); ++n) {
        const auto found = transforms.find(id);
        if (found == transforms.end() || !found->second.toParent || n == kMost) {
            volume.moved.reset();
            volume.unmoved = found == transforms.end() || found->second.name.empty() ? id : found->second.name;
            return;
        }
        const Placement& next = *found->second.toParent;
        all = {next.linear * all.linear, next.linear * all.shift + next.shift};
        volume.moved = all;
        id = found->second.parent;
    }
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
        std::string name, storage, transform;
    };
    std::vector<Node> nodes;
    std::map<std::string, SceneTransform> transforms;
    std::map<std::string, std::string> files; // of storage nodes
    for (std::size_t n = 0; tags.next(tag); ++n) {
        if (n >= kMostNodes) throw fail("there are too many nodes in the scene", "save a smaller one");
        if (!tag.opens) continue;
        if (tag.name.ends_with("Volume") && !referenceOf(tag, "storage").empty())
            nodes.push_back({tag.get("name"), referenceOf(tag, "storage"), referenceOf(tag, "transform")});
        if (tag.name.ends_with("Transform"))
            transforms[tag.get("id")] = {printable(tag.get("name").substr(0, 100)), referenceOf(tag, "transform"),
                                         placementIn(tag.get("matrixTransformToParent"))};
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
        volumes.push_back({name, fileOf(path, file->second), {}, {}});
        placeUnder(volumes.back(), node.transform, transforms);
    }
    if (volumes.empty())
        throw fail("the scene has no volumes that have been saved", "save the scene in 3D Slicer with its volumes");
    return volumes;
}

/// The volume of a scene that `source` names; the first one where it names none.
const SceneVolume& chosenIn(const std::vector<SceneVolume>& volumes, const VolumeSource& source) {
    auto chosen = volumes.begin();
    if (!source.array.empty()) chosen = std::ranges::find(volumes, source.array, &SceneVolume::name);
    if (chosen == volumes.end())
        throw UsageError("there is no volume " + inQuotes(source.array), source.path,
                         "it has " + joined(volumes, ", ", [](const SceneVolume& v) { return inQuotes(v.name); }));
    // By its content, too: that tells the format, and a scene could name itself by another suffix.
    if (lowerCase(chosen->path).ends_with(".mrml") || contentOf(chosen->path) == kMrmlContent)
        throw FileError("the scene names another scene as a volume", source.path, "save it again");
    return *chosen;
}

/// `source` for the file of a volume.
VolumeSource sourceOf(const SceneVolume& volume, const VolumeSource& source) {
    VolumeSource file = source;
    file.path = volume.path;
    file.array.clear();
    return file;
}

/// `volume` where the scene has it.
Volume placed(Volume volume, const SceneVolume& inScene, const std::string& scene) {
    const std::string under = "the volume is under a transform in the scene";
    if (!inScene.unmoved.empty())
        volume.notices.push_back(under + ", " + printable(inQuotes(inScene.unmoved)) +
                                 ", which is not applied: harden it in 3D Slicer");
    if (!inScene.moved) return volume;
    if (volume.elsewhere() != nullptr) { // blocks on ranks lie on the grid of the file
        volume.notices.push_back(under + ", which is not applied on several ranks: harden it in 3D Slicer");
        return volume;
    }
    if (volume.geometry().worldAxes != WorldAxes::Patient) {
        volume.notices.push_back(under + ", which is not applied: the volume is not in a patient's world");
        return volume;
    }
    Geometry geometry = volume.geometry();
    const Mat3 axes = inScene.moved->linear * geometry.worldFromIndex();
    for (int a = 0; a < 3; ++a) {
        geometry.spacing[a] = glm::length(axes[a]);
        geometry.directions[a] = cleanDirection(axes[a] / geometry.spacing[a]);
    }
    geometry.origin = inScene.moved->linear * geometry.origin + inScene.moved->shift;
    constexpr double kFlat = 1e-6;
    const std::string problem = geometryProblem(geometry.spacing, geometry.origin);
    if (!problem.empty() || !(std::abs(glm::determinant(geometry.directions)) > kFlat))
        throw FileError("the volume's transform in the scene " +
                            (problem.empty() ? "would make it flat" : "cannot be used: " + problem),
                        scene, "correct the transform in 3D Slicer");
    volume.notices.push_back(under + ", and lies where that puts it");
    return volume.withGeometry(geometry);
}

FileContents describe(const VolumeSource& source, const JobControl& job) {
    const std::vector<SceneVolume> volumes = readScene(source.path, job);
    const SceneVolume& chosen = chosenIn(volumes, source);
    const VolumeSource file = sourceOf(chosen, source);
    FileContents contents = contentsOf(file, job);
    contents.arrays.clear();
    contents.details.clear();
    for (const SceneVolume& volume : volumes) {
        contents.arrays.push_back(volume.name);
        contents.details.push_back(printable(fs::path(volume.path).filename().string()));
    }
    contents.array = chosen.name;
    return contents;
}

Volume read(const VolumeSource& source, const JobControl& job) {
    const std::vector<SceneVolume> volumes = readScene(source.path, job);
    const SceneVolume& chosen = chosenIn(volumes, source);
    VolumeSource file = sourceOf(chosen, source);
    file.range.reset(); // who reads the scene applies both
    file.axes.reset();
    Volume volume = placed(loadVolume(file, job), chosen, source.path);
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
