// Of pellucid-array-reader.
#include "foreign/arrays/array_kind.h"
#include "foreign/foreign_volume.h"
#include "foreign/zarr/ome_zarr.h"
#include "volume/formats/reader.h"

namespace pellucid {

std::unique_ptr<ForeignVolume> openForeign(const std::string& path, const std::string& wanted,
                                           const BeforeFile& before) {
    if (holdsZarr(path)) return std::make_unique<OmeZarr>(path, wanted, before);
    switch (arrayKindOf(path)) {
    case ArrayKind::Hdf5:
    case ArrayKind::NetCdf:
    case ArrayKind::None:
        break;
    }
    throw FileError("this is neither HDF5 nor NetCDF", path, "name another file");
}

} // namespace pellucid
