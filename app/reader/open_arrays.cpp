// Of pellucid-array-reader.
#include "foreign/arrays/array_kind.h"
#include "foreign/arrays/array_volume.h"
#include "foreign/zarr/ome_zarr.h"
#include "volume/formats/content.h"
#include "volume/formats/reader.h"

namespace pellucid {

namespace {

std::unique_ptr<ArrayFile> openArrays(const std::string& path, const BeforeFile& before) {
    switch (arrayKindOf(path)) {
    case ArrayKind::Hdf5:
        return openHdf5(path, before);
    case ArrayKind::NetCdf:
        return openNetCdf(path, before);
    case ArrayKind::None:
        break;
    }
    const std::string content = contentOf(path);
    throw FileError("this is neither HDF5 nor NetCDF" + (content.empty() ? "" : " but " + content), path,
                    "give it the suffix of its own format, or write it anew");
}

} // namespace

std::unique_ptr<ForeignVolume> openForeign(const std::string& path, const std::string& wanted,
                                           const BeforeFile& before) {
    if (holdsZarr(path)) return std::make_unique<OmeZarr>(path, wanted, before);
    return std::make_unique<ArrayVolume>(openArrays(path, before), path, wanted);
}

} // namespace pellucid
