// Of pellucid-reader.
#include "foreign/dicom_series.h"

namespace pellucid {

std::unique_ptr<ForeignVolume> openForeign(const std::string& path, const std::string& wanted,
                                           const BeforeFile& before) {
    return std::make_unique<DicomSeries>(path, wanted, before);
}

} // namespace pellucid
