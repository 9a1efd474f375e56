// What VTK's XML files of image data (.vti, .pvti) say: all but the values of their arrays.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "base/job.h"
#include "volume/formats/vtk_bytes.h"
#include "volume/formats/xml_tags.h"

namespace pellucid {

/// Points lo … hi − 1 along each axis, as the file numbers them: the first one of an image need not be 0.
struct VtkExtent {
    glm::vec<3, std::int64_t> lo{0}, hi{0};
    bool isEmpty() const { return hi.x <= lo.x || hi.y <= lo.y || hi.z <= lo.z; }
    bool operator==(const VtkExtent&) const = default;
};

/// The points of both.
VtkExtent common(const VtkExtent& a, const VtkExtent& b);
/// As files have it, "0 7 0 7 0 7": its last point is one of it.
std::string textOf(const VtkExtent& extent);

/// One DataArray, or of a file that has its pieces in others, PDataArray.
struct VtkArray {
    std::string name, type, format;
    std::int64_t components = 1;
    std::uint64_t contentStart = 0; ///< byte of the file behind its tag
    std::uint64_t offset = 0;       ///< of appended data
    bool ofCells = false;
};

/// The arrays of points, then those of cells.
struct VtkArrays {
    std::string active; ///< name of the one of points to be shown; may be empty
    std::vector<VtkArray> all;
    std::vector<std::string> names() const; ///< as they are offered
};

/// A part of an image that is stored by itself.
struct VtkPiece {
    VtkExtent extent; ///< not empty, within the image
    std::string path; ///< the file that has its values
    VtkArrays arrays; ///< where that is the file that names it
};

/// A whole file. Pieces may share points, and need not cover the image: see requireCovered().
struct VtkImage {
    std::string path;
    bool piecesInFiles = false; ///< .pvti: each piece is a .vti of its own
    bool bigEndian = false;
    VtkPacking packing = VtkPacking::None;
    int headerBytes = 4;
    std::optional<VtkExtent> extent; ///< of the element ImageData, which has to be there
    std::string spacing, origin, direction;
    VtkArrays arrays; ///< those that each piece has to have, by name and type
    std::vector<VtkPiece> pieces;
    std::optional<VtkArray> time; ///< FieldData's TimeValue
    bool appendedBase64 = false;
    std::optional<std::uint64_t> appendedStart; ///< byte of the file that offset 0 is
};

/// The cells between the points of a part of an image, numbered like the points at which they begin. Along an axis
/// along which the whole image has one point there is one layer of cells.
VtkExtent cellsOf(const VtkExtent& part, const VtkExtent& whole);

/// Goes through a file of image data; where `piecesInFiles`, through one that names its pieces, and not through those.
/// Throws FileError.
VtkImage readVtkImage(const std::string& path, bool piecesInFiles, const JobControl& job);

/// Throws FileError unless each point of `extent` is one of a piece of `image`.
void requireCovered(const VtkImage& image, const VtkExtent& extent, const std::string& toDo, const JobControl& job);

/// Throws FileError unless a file could be XML.
void checkIsXml(const std::string& path);
/// The root of a file, which has to be a VTKFile of `type`.
void checkRoot(const XmlTag& tag, const std::string& type, const std::string& path);

/// Names by which arrays of points and cells are offered: "NAME (cells)" where points have an array of the same name.
std::vector<std::string> offeredNames(const std::vector<std::string>& ofPoints,
                                      const std::vector<std::string>& ofCells);
/// Which of `offered` is the array that is asked for; where none is, the one of the name `active`, else the first.
/// Throws UsageError for a name that is not there. `offered` is not empty.
std::size_t chosenOf(const std::vector<std::string>& offered, const std::string& asked, const std::string& active,
                     const std::string& path);
/// The values of a file are those of cells: said once for all formats.
inline constexpr const char* kCellsNotice = "the values are those of cells, each of which lies between points";

/// Throws FileError.
[[noreturn]] void failInVtk(const std::string& path, const std::string& what,
                            const std::string& toDo = "correct the file, or write it again");

} // namespace pellucid
