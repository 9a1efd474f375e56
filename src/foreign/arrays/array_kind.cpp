#include "foreign/arrays/array_kind.h"

#include <fstream>
#include <string_view>

#include "volume/formats/content.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

/// Behind a block of the user's, whose size is a power of two from 512 on (HDF5 file format, section II.A).
bool isHdf5BehindBlock(const std::string& path) {
    constexpr std::string_view kSignature("\x89HDF\r\n\x1a\n");
    std::ifstream in(path, std::ios::binary);
    std::string there(kSignature.size(), '\0');
    for (std::streamoff at = 512; in.seekg(at) && in.read(there.data(), std::ssize(there)); at *= 2)
        if (there == kSignature) return true;
    return false;
}

} // namespace

ArrayKind arrayKindOf(const std::string& path) {
    if (isFolder(path)) return ArrayKind::None;
    const std::string content = contentOf(path);
    if (content == kHdf5Content) return ArrayKind::Hdf5;
    if (content == kNetCdfContent) return ArrayKind::NetCdf;
    return isHdf5BehindBlock(path) ? ArrayKind::Hdf5 : ArrayKind::None;
}

} // namespace pellucid
