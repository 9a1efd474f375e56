// DICOM: files, folders and DICOMDIRs, read by GDCM in a process of its own (src/foreign, app/reader).
#include <filesystem>

#include "volume/formats/reader.h"
#include "volume/process/reader_process.h"

namespace pellucid {

namespace {

/// Throws FileError for a file that is clearly something else, whatever its suffix promises.
void requireNothingElse(const std::string& path) {
    std::error_code ec;
    if (std::filesystem::is_directory(path, ec)) return;
    const std::string head = fileHead(path, 1024), content = describeContent(head);
    if (content != "a DICOM file" && content != "binary data") throw notOfFormat("a DICOM file", path, head);
}

ReaderRequest requestOf(const VolumeSource& source) {
    requireNothingElse(source.path);
    ReaderRequest request;
    request.path = source.path;
    request.array = source.array;
    request.step = source.step;
    return request;
}

FileContents describe(const VolumeSource& source, const JobControl& job) {
    return describeInProcess(requestOf(source), job);
}

Volume read(const VolumeSource& source, const JobControl& job) { return readInProcess(source, requestOf(source), job); }

std::vector<std::string> dataFiles(const std::string& path) {
    ReaderRequest request;
    request.path = path;
    return listInProcess(request, {});
}

} // namespace

Volume readMiddleOfDicom(const VolumeSource& source, const JobControl& job) {
    ReaderRequest request = requestOf(source);
    request.middleOnly = true;
    return readInProcess(source, request, job);
}

bool isDicom(const std::string& path) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(path, ec)) return false;
    try {
        return describeContent(fileHead(path, 1024)) == "a DICOM file";
    } catch (const FileError&) {
        return false;
    }
}

bool holdsDicom(const std::string& folder) {
    namespace fs = std::filesystem;
    constexpr int kLookedAt = 64, kMostFolders = 8;
    std::error_code ec;
    int files = 0;
    for (auto it = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, ec);
         !ec && it != fs::recursive_directory_iterator() && files < kLookedAt; it.increment(ec)) {
        if (it.depth() >= kMostFolders) it.disable_recursion_pending();
        if (!it->is_regular_file(ec)) continue;
        ++files;
        const std::string path = it->path().string();
        if (isDicom(path)) return true;
        if (it.depth() == 0 && hasVolumeSuffix(path)) return false; // a folder of other volumes
    }
    return false;
}

VolumeFormat dicomFormat() { return {"DICOM", {".dcm", ".dicom", ".ima"}, describe, read, dataFiles}; }

} // namespace pellucid
