// VTK's collections of files over time (.pvd).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "volume/formats/reader.h"
#include "volume/formats/vtk_header.h"
#include "volume/outside_files.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 1'000'000;

/// A file of a collection.
struct CollectionEntry {
    std::string path;
    std::optional<double> time;
};

std::vector<CollectionEntry> readCollection(const std::string& path, const JobControl& job) {
    checkIsXml(path);
    XmlTags tags(path, job);
    XmlTag tag;
    std::vector<CollectionEntry> entries;
    bool isRoot = true, ended = false;
    while (tags.next(tag)) {
        if (isRoot) checkRoot(tag, "Collection", path);
        isRoot = false;
        ended = ended || (tag.name == "VTKFile" && tag.closes);
        if (tag.name != "DataSet" || !tag.opens) continue;
        if (entries.size() >= kMostFiles) failInVtk(path, "there are too many files in the collection");
        const std::string file = tag.get("file");
        if (file.empty()) failInVtk(path, "a data set of the collection names no file");
        if (file.size() > 1000) failInVtk(path, "the name of a file is too long");
        requireInside(path, file);
        if (lowerCase(file).ends_with(".pvd")) failInVtk(path, "the collection names another collection");
        CollectionEntry entry{(fs::path(path).parent_path() / file).string(), {}};
        const std::string text = trimmed(tag.get("timestep"));
        double time = 0;
        if (!text.empty() && (!parseNumber(text, time) || !std::isfinite(time)))
            failInVtk(path, "the time step " + inQuotes(text) + " is not a number");
        if (!text.empty()) entry.time = time;
        entries.push_back(std::move(entry));
    }
    if (entries.empty()) failInVtk(path, "the collection names no files");
    if (!ended) failInVtk(path, "the file ends within its element \"VTKFile\"", "copy it again");
    if (!std::ranges::all_of(entries, [](const CollectionEntry& e) { return e.time.has_value(); })) return entries;
    std::ranges::stable_sort(entries, {}, &CollectionEntry::time);
    if (std::ranges::adjacent_find(entries, {}, &CollectionEntry::time) != entries.end())
        failInVtk(path, "two files of the collection have the same time step", "write each step as one .vti or .pvti");
    return entries;
}

/// `source` for a file of a collection. Throws FileError for one that leads on to others, and maybe back.
VolumeSource sourceOf(const CollectionEntry& entry, const VolumeSource& source) {
    if (const std::string content = contentOf(entry.path); content == kPvdContent || content == kMrmlContent)
        failInVtk(source.path, "the collection names another collection");
    VolumeSource file = source;
    file.path = entry.path;
    return file;
}

std::vector<std::string> filesOfCollection(const std::string& path) {
    std::vector<std::string> files;
    for (const CollectionEntry& entry : readCollection(path, {})) {
        files.push_back(entry.path);
        if (!lowerCase(entry.path).ends_with(".pvti")) continue;
        try {
            for (std::string& piece : pvtiFormat().dataFiles(entry.path)) files.push_back(std::move(piece));
        } catch (const FileError&) {
            continue; // loadVolume() tells what is wrong with it
        }
    }
    return files;
}

FileContents describeCollection(const VolumeSource& source, const JobControl& job) {
    const std::vector<CollectionEntry> entries = readCollection(source.path, job);
    FileContents contents;
    for (const CollectionEntry& entry : entries) { // the first that can be read: one may be missing
        try {
            VolumeSource file = sourceOf(entry, source);
            file.frames.reset();
            contents = contentsOf(file, job);
            break;
        } catch (const FileError&) {
            if (&entry == &entries.back()) throw;
        }
    }
    contents.steps = static_cast<int>(entries.size());
    contents.times.clear();
    contents.timeUnit.clear();
    for (const CollectionEntry& entry : entries) {
        contents.stepFiles.push_back(entry.path);
        if (entry.time) contents.times.push_back(*entry.time);
    }
    if (contents.times.size() != entries.size()) contents.times.clear();
    return contents;
}

Volume readFromCollection(const VolumeSource& source, const JobControl& job) {
    const std::vector<CollectionEntry> entries = readCollection(source.path, job);
    requireIndex("time step", source.step, entries.size(), source.path);
    VolumeSource file = sourceOf(entries[static_cast<std::size_t>(source.step)], source);
    file.step = 0;
    file.range.reset();
    return loadVolume(file, job);
}

} // namespace

VolumeFormat pvdFormat() {
    return {"VTK collection", {".pvd"}, describeCollection, readFromCollection, filesOfCollection, kPvdContent};
}

} // namespace pellucid
