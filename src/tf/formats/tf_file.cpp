#include "tf/formats/tf_file.h"

#include <algorithm>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/tf_json.h"
#include "tf/presets.h"

namespace pellucid {

namespace {

bool endsWith(const std::string& path, const char* suffix) { return lowerCase(path).ends_with(suffix); }

/// Whose suffix nothing else has; null where it is none of these.
const TfFormat* formatOfSuffix(const std::string& path) {
    for (const TfFormat& f : tfFormats())
        if (f.ownSuffix && endsWith(path, f.suffix)) return &f;
    return nullptr;
}

bool isOurs(const TfFormat& format) { return format.read == pellucidTfFormat().read; }

bool exists(const std::string& path) {
    std::error_code failure;
    return std::filesystem::exists(path, failure);
}

/// A file and, behind a #, a name in it.
struct PartOfFile {
    std::string path, part;
};
PartOfFile partOf(const std::string& path) {
    if (exists(path)) return {path, {}};
    const std::size_t last = path.rfind('#');
    if (last == std::string::npos) return {path, {}};
    std::size_t mark = last; // names of files and of presets may have others
    while (mark > 0 && mark != std::string::npos && !exists(path.substr(0, mark))) mark = path.rfind('#', mark - 1);
    if (mark == 0 || mark == std::string::npos) mark = last;
    return {path.substr(0, mark), path.substr(mark + 1)};
}

} // namespace

const std::vector<std::string>& tfSuffixes() {
    static const std::vector<std::string> kSuffixes = [] {
        std::vector<std::string> all;
        for (const TfFormat& f : tfFormats())
            if (f.ownSuffix) all.emplace_back(f.suffix);
        return all;
    }();
    return kSuffixes;
}

bool hasTfSuffix(const std::string& path) { return formatOfSuffix(path) != nullptr; }

bool isTfFile(const std::string& path) {
    if (hasTfSuffix(path)) return true;
    const auto mayBe = {".json", ".xml", ".csv"};
    std::error_code failure;
    if (std::ranges::none_of(mayBe, [&](const char* suffix) { return endsWith(path, suffix); }) ||
        endsWith(path, ".pellucid.json") || !std::filesystem::is_regular_file(path, failure))
        return false;
    try {
        const ForeignFile file(path, readText(path));
        return std::ranges::any_of(tfFormats(), [&](const TfFormat& f) { return f.knows(file); });
    } catch (const Error&) {
        return false;
    }
}

bool isForeignTf(const std::string& path) {
    const std::string file = partOf(path).path;
    if (const TfFormat* format = formatOfSuffix(file)) return !isOurs(*format);
    try {
        return !isOurs(tfFormatOf(ForeignFile(file, readText(file))));
    } catch (const Error&) {
        return false;
    }
}

ReadTf openTfFile(const std::string& path) {
    const PartOfFile of = partOf(path);
    const ForeignFile file(of.path, readText(of.path), of.part);
    const TfFormat& format = tfFormatOf(file);
    if (!of.part.empty() && format.names == nullptr)
        throw FileError("it holds one transfer function, and none that is called " + inQuotes(of.part), of.path,
                        "leave out # and what follows it");
    return format.read(file);
}

std::vector<std::string> tfNamesIn(const std::string& path) {
    const ForeignFile file(path, readText(path));
    const TfFormat& format = tfFormatOf(file);
    std::vector<std::string> names;
    if (format.names != nullptr) names = format.names(file);
    return names.size() > 1 ? names : std::vector<std::string>{};
}

std::string fileOfTf(const std::string& path) { return partOf(path).path; }

TransferFunction readTfFile(const std::string& path) { return openTfFile(path).tf; }

ReadTf readTfNamed(const std::string& specOrPath) {
    ReadTf read;
    if (auto tf = tfFromSpec(specOrPath)) {
        read.tf = std::move(*tf);
        return read;
    }
    if (auto tf = tfFromPresetSpec(specOrPath)) {
        read.tf = std::move(*tf);
        return read;
    }
    if (!exists(partOf(specOrPath).path))
        throw FileError("no such file", specOrPath, "check the name, or give auto, tents:N, ramp:N or preset:NAME");
    return openTfFile(specOrPath);
}

TransferFunction loadTf(const std::string& specOrPath) { return readTfNamed(specOrPath).tf; }

TransferFunction forVolume(const ReadTf& read, const Geometry& geometry) {
    if (read.opensAsItIs || !read.hasOpacities) return read.tf;
    return withOpacitiesPer(read.tf, geometry.d0() / read.length.inWorld(geometry));
}

TransferFunction forVolume(const ReadTf& read, const Volume& data) {
    TransferFunction tf = forVolume(read, data.geometry());
    if (read.spansData && data.dataRange().lo < data.dataRange().hi) tf.range = data.dataRange();
    return tf;
}

std::vector<std::string> openingNotices(const ReadTf& read, const Geometry& geometry,
                                        const std::optional<ValueRange>& values) {
    std::vector<std::string> notices = read.notices;
    if (read.positions) notices.push_back(noDomainNotice(*read.positions, values));
    const double length = read.length.inWorld(geometry), d0 = geometry.d0();
    if (!read.hasOpacities || length == d0) return notices;
    if (read.opensAsItIs)
        notices.push_back("opacities are taken for paths of one voxel, " + plainText(d0) +
                          ", as the thesis has it; the program that wrote them draws them for " + plainText(length));
    else
        notices.push_back("opacities are converted from paths of " + plainText(length) + " to those of one voxel, " +
                          plainText(d0));
    return notices;
}

std::string presetNameOf(const std::string& path) {
    std::string name = std::filesystem::path(path).filename().string();
    for (const TfFormat& f : tfFormats())
        if (endsWith(name, f.suffix)) return name.substr(0, name.size() - std::string(f.suffix).size());
    return std::filesystem::path(name).stem().string();
}

bool isWrittenForOthers(const std::string& path) {
    const TfFormat* format = formatOfSuffix(path);
    return format != nullptr && !isOurs(*format);
}

std::vector<std::string> writeTfFile(const TfToWrite& tf, const std::string& path) {
    if (!isWrittenForOthers(path)) {
        writeTf(tf.tf(), path);
        return {};
    }
    WrittenTf written = writtenTf(*formatOfSuffix(path), tf);
    writeTextAtomically(path, written.text);
    return std::move(written.losses);
}

} // namespace pellucid
