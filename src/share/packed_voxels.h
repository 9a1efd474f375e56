// The voxels of a volume as a page has them: intensities of 8 or 16 bits, deflated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/job.h"
#include "volume/volume.h"

namespace pellucid {

/// How intensities become codes: intensity = code / maxCode.
struct ShareCodes {
    int bits = 8;      ///< 8 or 16
    int maxCode = 255; ///< up to 255 or 65535; exact codes of integers are value − lo
    bool exact = false;
    /// The most that a code is off an intensity.
    double largestError() const { return exact ? 0 : 0.5 / maxCode; }
};
/// `bits` 8, 16, or 0: 8 where these are exact, else 16. Codes are exact where samples are integers and their window
/// spans no more than fit.
ShareCodes shareCodes(const Volume& volume, int bits);

/// Planes of a byte per voxel, x fastest, one after the other: of 16 bits the high bytes; the low ones; where any voxel
/// is invalid, 1 where one is valid (codes of others are 0).
std::vector<unsigned char> voxelPlanes(const Volume& volume, const ShareCodes& codes, const JobControl& job = {});

/// RFC 1950. Throws Cancelled.
std::vector<unsigned char> deflated(std::span<const unsigned char> bytes, const JobControl& job = {});

/// About how many bytes deflated() makes of a voxel of voxelPlanes(), from some layers of the volume.
double packedBytesPerVoxel(const Volume& volume, const ShareCodes& codes);

} // namespace pellucid
