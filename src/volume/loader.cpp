#include "volume/loader.h"

#include <algorithm>
#include <filesystem>

#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/excerpt.h"
#include "volume/formats/reader.h"
#include "volume/formats/text_header.h"
#include "volume/procedural.h"
#include "volume/process/reader_process.h"
#include "volume/series.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

constexpr std::string_view kSamplePrefix = "sample:";

const std::vector<VolumeFormat>& formats() {
    static const std::vector<VolumeFormat> kFormats{nrrdFormat(), metaImageFormat(), niftiFormat(),     vtiFormat(),
                                                    pvtiFormat(), pvdFormat(),       vtkLegacyFormat(), pvmFormat(),
                                                    datFormat(),  vvdFormat(),       imageFormat(),     dicomFormat(),
                                                    hdf5Format(), netCdfFormat(),    mrmlFormat()};
    return kFormats;
}

/// By VolumeFormat::content; null where no format has this one.
const VolumeFormat* formatOfContent(const std::string& content) {
    for (const VolumeFormat& format : formats())
        if (format.content != nullptr && content == format.content) return &format;
    return nullptr;
}

/// Of a folder whose files are together one volume; null for others.
const VolumeFormat* formatOfFolder(const std::string& path) {
    static const VolumeFormat kZarr = zarrFormat(), kDicom = dicomFormat(), kImages = imageFormat();
    return holdsZarr(path) ? &kZarr : holdsDicom(path) ? &kDicom : holdsImages(path) ? &kImages : nullptr;
}

bool hasOneOf(const std::string& path, const std::vector<std::string>& suffixes) {
    const std::string lower = lowerCase(std::filesystem::path(path).filename().string());
    return std::ranges::any_of(
        suffixes, [&](const std::string& suffix) { return lower.size() > suffix.size() && lower.ends_with(suffix); });
}

/// Null where the suffix promises none.
const VolumeFormat* formatOfSuffix(const std::string& path) {
    for (const VolumeFormat& format : formats())
        if (hasOneOf(path, format.suffixes)) return &format;
    return nullptr;
}

/// Of a file that is only a part, which has its header beside it.
const VolumeFormat* formatBeside(const std::string& path) {
    for (const VolumeFormat& format : formats())
        if (format.isBeside != nullptr && hasOneOf(path, format.sharedSuffixes) && format.isBeside(path))
            return &format;
    return nullptr;
}

/// Whether a file is a picture that no format takes: one slice, which may be one of a folder.
bool isLonePicture(const std::string& path) {
    return hasOneOf(path, {".png", ".jpg", ".jpeg", ".bmp"}) && contentOf(path).ends_with(" image");
}

/// By what is in the file; where that does not tell, by the suffix. Null where neither does.
const VolumeFormat* findFormat(const std::string& path) {
    if (isFolder(path)) {
        const VolumeFormat* bySuffix = formatOfSuffix(path);
        return bySuffix != nullptr ? bySuffix : formatOfFolder(path);
    }
    if (const VolumeFormat* byContent = formatOfContent(contentOf(path))) return byContent;
    const VolumeFormat* bySuffix = formatOfSuffix(path);
    return bySuffix != nullptr ? bySuffix : formatBeside(path);
}

/// Why a file is no volume, where its suffix says what it is instead.
std::optional<FileError> problemOfSuffix(const std::string& path) {
    const auto ofGrid = [&](const std::string& kind) {
        return FileError("this is a " + kind + " grid of VTK, whose points need not be evenly spaced", path,
                         "resample it to an image (.vti), as ParaView's filter Resample To Image does");
    };
    if (hasOneOf(path, {".vtr", ".pvtr"})) return ofGrid("rectilinear");
    if (hasOneOf(path, {".vts", ".pvts"})) return ofGrid("structured");
    if (hasOneOf(path, {".vtu", ".pvtu"})) return ofGrid("unstructured");
    if (hasOneOf(path, {".bz2", ".xz", ".zst", ".zip", ".7z"}))
        return FileError("of compressed files, only those compressed by gzip can be read: .nii.gz, .hdr.gz and "
                         "headerless data",
                         path, "unpack it first");
    if (isLonePicture(path))
        return FileError("this is a picture: one slice, not a volume", path,
                         "put all slices into a folder and open that, or save this one as TIFF");
    return {};
}

/// Throws FileError where there is none for this suffix.
const VolumeFormat& formatOf(const std::string& path) {
    if (const VolumeFormat* format = findFormat(path)) return *format;
    if (const auto problem = problemOfSuffix(path)) throw *problem;
    const bool named =
        hasOneOf(path, {".raw", ".raw.gz"}) || std::ranges::any_of(formats(), [&](const VolumeFormat& format) {
            return hasOneOf(path, format.sharedSuffixes);
        });
    std::vector<std::string> suffixes;
    for (const VolumeFormat& format : formats())
        suffixes.insert(suffixes.end(), format.suffixes.begin(), format.suffixes.end());
    throw FileError(named ? "headerless data needs its layout" : "the suffix names no known volume format", path,
                    named ? "" : "give one of " + joined(suffixes, " "), Remedy::GiveRawLayout);
}

void requireNotEmpty(const std::string& path) {
    if (isVolumeFolder(path)) return;
    if (readableFileBytes(path) == 0) throw FileError("the file is empty", path, "copy it again");
}

Volume readFile(const VolumeSource& source, const JobControl& job) {
    requireNotEmpty(source.path);
    const VolumeFormat* format = source.raw ? nullptr : &formatOf(source.path);
    Volume volume = format != nullptr ? format->read(source, job) : readRaw(source, job);
    if (volume.format.empty()) volume.format = format != nullptr ? format->name : "raw";
    const std::filesystem::path path(source.path);
    volume.title = printable((path.has_filename() ? path : path.parent_path()).filename().string());
    return volume;
}

Volume sample(const VolumeSource& source, const JobControl& job) {
    if (source.raw) throw UsageError("a sample has no raw layout", source.path, "leave it out");
    if (source.component != 0)
        throw UsageError("a sample has one component", source.path, "leave the component out", Remedy::NoComponent);
    Volume volume = makeSample(source.path.substr(kSamplePrefix.size()), source.sampleSize, source.seed, job,
                               source.downsample > 1 || source.region ? MemoryUse{} : source.then, source.step);
    if (source.missing) {
        Volume other(volume.geometry(), volume.samples(), source.missing);
        if (volume.range() != volume.dataRange()) other = other.withRange(volume.range());
        other.title = volume.title;
        other.format = volume.format;
        volume = std::move(other);
    }
    // A sample has a size of its own to be chosen: only what is asked for makes it coarser.
    VolumeSource asked = source;
    asked.downsample = std::max(1, source.downsample);
    const ExcerptPlan plan = planExcerpt(asked, volume.dims(), volume.sampleType(), false);
    return plan.isWhole() ? volume : excerptOf(volume, plan);
}

} // namespace

RawLayout parseRawLayout(const std::string& text) {
    const auto fail = [&](const std::string& why) {
        return UsageError(why, "raw layout " + text,
                          "give NX,NY,NZ,TYPE[,little|big], TYPE one of u8 i8 u16 i16 u32 i32 f32 f64");
    };
    const std::vector<std::string> parts = splitAt(',', text);
    if (parts.size() < 4 || parts.size() > 5) throw fail("the layout has " + std::to_string(parts.size()) + " parts");
    RawLayout layout;
    for (int a = 0; a < 3; ++a) {
        std::int64_t size = 0;
        const std::string& part = parts[static_cast<std::size_t>(a)];
        if (!parseNumber(part, size) || size < 1 || size > std::numeric_limits<int>::max())
            throw fail("'" + part + "' is not a number of voxels");
        layout.dims[a] = static_cast<int>(size);
    }
    const auto type = findNamed<SampleType>(parts[3]);
    if (!type) throw fail("'" + parts[3] + "' is not a sample type");
    layout.type = *type;
    if (parts.size() == 5) {
        if (parts[4] != "little" && parts[4] != "big") throw fail("'" + parts[4] + "' is not a byte order");
        layout.bigEndian = parts[4] == "big";
    }
    return layout;
}

namespace {

std::function<Volume(const VolumeSource&, const JobControl&)>& loader() {
    static std::function<Volume(const VolumeSource&, const JobControl&)> load;
    return load;
}

} // namespace

void setVolumeLoader(std::function<Volume(const VolumeSource&, const JobControl&)> load) { loader() = std::move(load); }

Volume loadVolume(const VolumeSource& source, const JobControl& job) {
    return loader() ? loader()(source, job) : loadHere(source, job);
}

Volume loadHere(const VolumeSource& source, const JobControl& job) {
    if (source.path.empty()) throw UsageError("no volume is named", "", "give a file or sample:NAME");
    const bool builtIn = source.isSample();
    Volume volume = builtIn ? sample(source, job) : readFile(source, job);
    if (!volume.hasValidVoxels())
        volume.notices.emplace_back("no voxel has a valid value");
    else if (volume.isConstant())
        volume.notices.push_back(
            (volume.invalidCount() > 0 ? "all valid voxels have the value " : "all voxels have the value ") +
            exactText(volume.dataRange().lo));
    if (source.spacing)
        std::erase_if(volume.notices, [](const std::string& notice) { return notice.ends_with(kUnlessSet); });
    if (source.axes || source.spacing) volume = withPlacement(volume, source.axes, source.spacing);
    if (source.range) volume = volume.withRange(*source.range);
    job.report(1.0);
    return volume;
}

std::vector<std::string> filesOf(const VolumeSource& source) {
    if (source.isSample()) return {};
    std::vector<std::string> files;
    const std::vector<std::string> paths = seriesFiles(source);
    for (const std::string& path : paths) {
        files.push_back(path);
        const VolumeFormat* format = source.raw ? nullptr : findFormat(path);
        if (format == nullptr || format->dataFiles == nullptr) continue;
        try {
            for (std::string& data : format->dataFiles(path)) files.push_back(std::move(data));
        } catch (const TakesTooLong&) {
            if (paths.size() == 1) throw; // it would the next time
        } catch (const Error&) {
            continue; // loadVolume() tells what is wrong with it
        }
    }
    return files;
}

FileContents contentsOf(const VolumeSource& source, const JobControl& job) {
    if (source.raw) {
        FileContents contents;
        contents.dims = source.raw->dims;
        contents.type = source.raw->type;
        contents.steps = rawSteps(source, job);
        return contents;
    }
    requireNotEmpty(source.path);
    return formatOf(source.path).describe(source, job);
}

bool isVolumeFolder(const std::string& path) { return isFolder(path) && formatOfFolder(path) != nullptr; }

bool mayHoldSeveral(const std::string& path) {
    const VolumeFormat* format = findFormat(path);
    return format != nullptr && format->holdsSeveral;
}

Volume loadMiddleSlice(const VolumeSource& source, const JobControl& job) {
    requireNotEmpty(source.path);
    const VolumeFormat& format = formatOf(source.path);
    if (format.readMiddle != nullptr) return format.readMiddle(source, job);
    const Int3 dims = format.describe(source, job).dims;
    VolumeSource middle = source;
    middle.region = VoxelRegion{{0, 0, dims.z / 2}, {dims.x, dims.y, dims.z / 2 + 1}};
    return format.read(middle, job);
}

bool hasVolumeSuffix(const std::string& path) {
    return !isFolder(path) && (formatOfSuffix(path) != nullptr || formatOfContent(contentOf(path)) != nullptr);
}

bool mayBeHeaderless(const std::string& path) {
    std::error_code ec;
    return std::filesystem::is_regular_file(path, ec) && findFormat(path) == nullptr && !problemOfSuffix(path);
}

const std::vector<std::string>& volumeFilePatterns() {
    static const std::vector<std::string> kPatterns = [] {
        std::vector<std::string> patterns;
        for (const VolumeFormat& format : formats())
            for (const auto* suffixes : {&format.suffixes, &format.sharedSuffixes})
                for (const std::string& suffix : *suffixes) patterns.push_back("*" + suffix);
        return patterns;
    }();
    return kPatterns;
}

} // namespace pellucid
