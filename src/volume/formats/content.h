// What a file is by its first bytes, whatever its name says.
#pragma once

#include <string>
#include <string_view>

namespace pellucid {

/// What describeContent() says of files that we read: each a VolumeFormat::content.
inline constexpr const char *kNrrdContent = "an NRRD file", *kMetaImageContent = "a MetaImage file",
                            *kNiftiContent = "a NIfTI file", *kVtiContent = "a VTK image (VTI)",
                            *kPvtiContent = "a VTK image in pieces (PVTI)", *kPvdContent = "a VTK collection (PVD)",
                            *kVtkLegacyContent = "a VTK file", *kPvmContent = "a PVM file",
                            *kDatContent = "a header of Voreen or Inviwo",
                            *kVvdContent = "a volume description of Voreen", *kDicomContent = "a DICOM file",
                            *kTiffContent = "a TIFF image", *kHdf5Content = "an HDF5 file",
                            *kNetCdfContent = "a NetCDF file", *kMrmlContent = "a scene of 3D Slicer";

/// So many first bytes of a file tell what it is.
inline constexpr std::size_t kHeadBytes = 1024;

/// What a file seems to be: one of the above, or for error messages "a PNG image", "text", "binary data", …
std::string describeContent(std::string_view head);
/// The same of a file; empty where it is none, or cannot be read.
std::string contentOf(const std::string& path);
/// Whether a file is packed by gzip. Throws FileError where it cannot be read.
bool isGzip(const std::string& path);
/// Whether bytes begin with the size of a NIfTI header, in either byte order, as those of Analyze do, too.
bool beginsLikeNifti(std::string_view head);

} // namespace pellucid
