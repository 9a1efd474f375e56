// The pixels of DICOM files, whatever they are packed by.
#pragma once

#include <cstdint>
#include <vector>

#include "foreign/dicom_header.h"

namespace pellucid {

/// The pictures of the file that `frame` is in, one after the other as they are stored: row by row, samples of a pixel
/// beside each other, each of bitsAllocated bits in this machine's byte order. Colours that are stored as brightness
/// and hue come out as red, green and blue. Throws FileError for what cannot be unpacked, or has another size than the
/// header says.
std::vector<char> unpackDicom(const DicomFrame& frame);

} // namespace pellucid
