// Formats that are read by libraries, in processes of their own (src/foreign, app/reader): DICOM by GDCM, pictures as
// slices by OpenImageIO, arrays in HDF5 and NetCDF by libhdf5, Zarr by the libraries that unpack its chunks.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>

#include "volume/file_names.h"
#include "volume/formats/reader.h"
#include "volume/process/reader_process.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr const char *kOfDicom = "pellucid-reader", *kOfTiff = "pellucid-tiff-reader",
                     *kOfImages = "pellucid-image-reader", *kOfArrays = "pellucid-array-reader";

ReaderRequest requestOf(const VolumeSource& source, const char* program) {
    ReaderRequest request;
    request.program = program;
    request.path = source.path;
    request.array = source.array;
    request.step = source.step;
    return request;
}

bool isTiffName(const std::string& suffix) { return suffix == ".tif" || suffix == ".tiff"; }

/// Throws FileError for a file that is clearly something else, whatever its suffix promises.
ReaderRequest dicomRequest(const VolumeSource& source) {
    if (!isFolder(source.path)) {
        const std::string head = fileHead(source.path, 1024), content = describeContent(head);
        if (content != kDicomContent && content != "binary data") throw notOfFormat("a DICOM file", source.path, head);
    }
    return requestOf(source, kOfDicom);
}
ReaderRequest imageRequest(const VolumeSource& source) {
    if (!isFolder(source.path)) {
        const std::string head = fileHead(source.path, 1024);
        if (describeContent(head) != kTiffContent) throw notOfFormat("a TIFF image", source.path, head);
    }
    // OpenImageIO takes long to load: TIFF need not wait for it.
    const std::vector<std::string> images = isFolder(source.path) ? imagesIn(source.path) : std::vector<std::string>{};
    const bool isTiff = images.empty() || isTiffName(volumeSuffix(images.front()));
    return requestOf(source, isTiff ? kOfTiff : kOfImages);
}
/// HDF5 may stand behind anything: the reader tells what is none.
ReaderRequest arrayRequest(const VolumeSource& source) {
    if (volumeSuffix(source.path) == ".mat" && fileHead(source.path, 10) == "MATLAB 5.0")
        throw FileError("MATLAB's files are read from version 7.3 on, this is an older one", source.path,
                        "save it in MATLAB by save(…, '-v7.3')");
    return requestOf(source, kOfArrays);
}

ReaderRequest zarrRequest(const VolumeSource& source) { return requestOf(source, kOfArrays); }

/// A number that is another one once a file has changed that the answer comes from; empty where these are not known, or
/// too many to look at.
std::optional<std::size_t> stateOf(const ReaderRequest& request) {
    constexpr int kMostFiles = 20'000;
    std::size_t state = 0;
    int left = kMostFiles;
    const auto add = [&](const fs::directory_entry& file) {
        std::error_code ec;
        for (const std::size_t part :
             {std::hash<std::string>{}(file.path().string()), static_cast<std::size_t>(file.file_size(ec)),
              static_cast<std::size_t>(file.last_write_time(ec).time_since_epoch().count())})
            state = (state ^ part) * 1'099'511'628'211u;
        return --left == 0;
    };
    const fs::path path(request.path);
    if (isFolder(request.path)) {
        anyFileBelow(request.path, add);
    } else if (request.program != kOfDicom) {
        add(fs::directory_entry(path));
    } else if (path.filename() == "DICOMDIR") {
        return {}; // it names files in any folder
    } else {       // a slice stands for its series
        for (const std::string& file : filesIn(path.has_parent_path() ? path.parent_path().string() : "."))
            if (add(fs::directory_entry(file))) break;
    }
    return left > 0 ? std::optional(state) : std::nullopt;
}

/// What describeInProcess() says; the latest answers are kept as long as the files stay as they are. Opening asks
/// several times what there is, and of a large study each answer takes seconds.
ReaderDescription described(const ReaderRequest& request, const JobControl& job) {
    struct Known {
        std::string program, path, array;
        std::size_t state;
        ReaderDescription description;
    };
    constexpr std::size_t kMost = 16;
    static std::mutex s_mutex;
    static std::list<Known> s_known; // the latest first
    const std::optional<std::size_t> state = stateOf(request);
    const auto isSame = [&](const Known& k) {
        return k.program == request.program && k.path == request.path && k.array == request.array;
    };
    {
        const std::lock_guard lock(s_mutex);
        const auto known = std::ranges::find_if(s_known, isSame);
        if (known != s_known.end() && state && known->state == *state) return known->description;
    }
    ReaderDescription description = describeInProcess(request, job);
    if (!state) return description;
    const std::lock_guard lock(s_mutex);
    s_known.remove_if(isSame);
    s_known.push_front({request.program, request.path, request.array, *state, description});
    if (s_known.size() > kMost) s_known.pop_back();
    return description;
}

template <auto requestFor>
FileContents describe(const VolumeSource& source, const JobControl& job) {
    return described(requestFor(source), job).contents;
}
template <auto requestFor>
Volume read(const VolumeSource& source, const JobControl& job) {
    return readInProcess(source, requestFor(source), job);
}
template <auto requestFor>
std::vector<std::string> dataFiles(const std::string& path) {
    VolumeSource source;
    source.path = path;
    return described(requestFor(source), {}).files;
}

/// Whether a TIFF file has a second page: a stack by itself. By its first directory (TIFF 6.0, section 2; BigTIFF has
/// numbers of 8 bytes).
bool hasSeveralPages(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::array<char, 16> head{};
    in.read(head.data(), head.size());
    const bool isBigEndian = head[0] == 'M', isLarge = head[2] == '+' || head[3] == '+';
    const auto number = [&](const char* bytes, std::size_t count) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i)
            value = value << 8 | static_cast<unsigned char>(bytes[isBigEndian ? i : count - 1 - i]);
        return value;
    };
    const std::size_t counts = isLarge ? 8 : 2, entry = isLarge ? 20 : 12, offset = isLarge ? 8 : 4;
    const std::uint64_t first = isLarge ? number(head.data() + 8, 8) : number(head.data() + 4, 4);
    in.seekg(static_cast<std::streamoff>(first));
    in.read(head.data(), static_cast<std::streamsize>(counts));
    const std::uint64_t entries = number(head.data(), counts);
    if (!in || entries > 65535) return false;
    in.seekg(static_cast<std::streamoff>(entries * entry), std::ios::cur);
    in.read(head.data(), static_cast<std::streamsize>(offset));
    return in && number(head.data(), offset) != 0;
}

} // namespace

bool isDicom(const std::string& path) { return contentOf(path) == kDicomContent; }

bool holdsDicom(const std::string& folder) {
    // A folder of other volumes may have folders of DICOM in it.
    const bool hasVolumes = std::ranges::any_of(filesIn(folder), [](const std::string& path) {
        return !isTiffName(volumeSuffix(path)) && !isDicom(path) && hasVolumeSuffix(path);
    });
    if (hasVolumes) return false;
    int left = 64; // files that are looked at
    bool found = false;
    anyFileBelow(folder, [&](const fs::directory_entry& file) {
        found = isDicom(file.path().string());
        return found || --left == 0;
    });
    return found;
}

bool holdsZarr(const std::string& folder) {
    std::error_code ec;
    return std::ranges::any_of(std::array{"zarr.json", ".zattrs", ".zgroup", ".zarray"},
                               [&](const char* name) { return fs::is_regular_file(fs::path(folder) / name, ec); });
}

std::vector<std::string> imagesIn(const std::string& folder) {
    std::map<std::string, std::vector<std::string>> bySuffix;
    for (const std::string& path : filesIn(folder)) {
        const std::string suffix = volumeSuffix(path);
        for (const char* known : {".tif", ".tiff", ".png", ".jpg", ".jpeg", ".bmp"})
            if (suffix == known) bySuffix[suffix].push_back(path);
    }
    std::vector<std::string> most;
    for (auto& [suffix, paths] : bySuffix)
        if (paths.size() > most.size()) most = std::move(paths);
    std::ranges::sort(most, countsBefore);
    return most;
}

bool holdsImages(const std::string& folder) {
    const std::vector<std::string> images = imagesIn(folder);
    if (images.size() < 2 || hasSeveralPages(images.front())) return false;
    return std::ranges::none_of(filesIn(folder), [](const std::string& path) {
        return hasVolumeSuffix(path) && !isTiffName(volumeSuffix(path));
    });
}

namespace {

template <auto requestFor>
Volume readMiddle(const VolumeSource& source, const JobControl& job) {
    return readMiddleInProcess(source, requestFor(source), job);
}

/// A format that a reader process reads.
template <auto requestFor>
VolumeFormat foreignFormat(const char* name, std::vector<std::string> suffixes, const char* content) {
    VolumeFormat format{name,   std::move(suffixes), describe<requestFor>, read<requestFor>, dataFiles<requestFor>,
                        content};
    format.holdsSeveral = true;
    format.readMiddle = readMiddle<requestFor>;
    return format;
}

} // namespace

VolumeFormat dicomFormat() { return foreignFormat<dicomRequest>("DICOM", {".dcm", ".dicom", ".ima"}, kDicomContent); }

VolumeFormat imageFormat() { return foreignFormat<imageRequest>("pictures", {".tif", ".tiff"}, kTiffContent); }

VolumeFormat zarrFormat() { return foreignFormat<zarrRequest>("OME-Zarr", {}, nullptr); }

VolumeFormat hdf5Format() {
    return foreignFormat<arrayRequest>("HDF5", {".h5", ".hdf5", ".hdf", ".he5", ".mat"}, kHdf5Content);
}

VolumeFormat netCdfFormat() {
    return foreignFormat<arrayRequest>("NetCDF", {".nc", ".nc4", ".cdf", ".netcdf"}, kNetCdfContent);
}

} // namespace pellucid
