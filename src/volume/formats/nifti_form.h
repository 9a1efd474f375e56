// Where fields stand in the headers of NIfTI, for who reads and who writes them.
#pragma once

#include <cstddef>

namespace pellucid {

/// Version 1 has 16-bit integers and single precision, 2 has wider ones: dim and the place of the data 64 bits, codes
/// 32 bits, numbers double precision. datatype and bitpix have 16 bits in both.
struct NiftiForm {
    int version;
    std::size_t bytes, magic;
    std::size_t datatype, bitpix, dim, pixdim, voxOffset, slope, intercept, timeOffset;
    std::size_t qformCode, sformCode, qform, sform, units, intent;
};
inline constexpr NiftiForm kNiftiForms[]{
    {1, 348, 344, 70, 72, 40, 76, 108, 112, 116, 136, 252, 254, 256, 280, 123, 68},
    {2, 540, 4, 12, 14, 16, 104, 168, 176, 184, 216, 344, 348, 352, 400, 500, 504},
};
/// What follows the mark of version 2.
inline constexpr char kNifti2Mark[] = "\r\n\032\n";

} // namespace pellucid
