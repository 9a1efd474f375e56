// A file of pictures, page by page: TIFF by libtiff, which tells what cannot be read.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "foreign/foreign_volume.h"

namespace pellucid {

/// One page. Samples of a pixel lie beside each other.
struct PageShape {
    int width = 0, height = 0, samples = 1;
    ValueType type = ValueType::U8;
    bool isBilevel = false; ///< stored with one bit for each pixel; bytes of 0 and 1 when read
    bool operator==(const PageShape&) const = default;
};
std::string textOf(const PageShape& shape); ///< "3 x 2 pixels, 1 sample of 16 bits"
std::uint64_t bytesOf(const PageShape& shape);

class PictureFile {
public:
    virtual ~PictureFile() = default;
    /// Goes to a page, from 0; false where there is none.
    virtual bool goTo(int page) = 0;
    /// Of the page it is at. Throws FileError for pictures of a kind that is not supported.
    virtual PageShape shape() = 0;
    virtual void read(std::span<std::byte> to) = 0; ///< the page it is at. Throws FileError
    /// Where the pixels of the page it is at need no library. Empty where they do, or where that is not known.
    virtual std::optional<PlainValues> plainPixels() { return {}; }
    virtual std::string description() { return {}; }
    /// What people should know of the page it is at.
    virtual std::vector<std::string> notices() { return {}; }
    virtual double pixelsPerUnit([[maybe_unused]] int axis) { return 0; } ///< 0: not known
};

/// Of a picture that cannot be read, and what its library says.
FileError pictureFailure(const std::string& path, const std::string& what, const std::string& why = "",
                         const std::string& toDo = "copy or write the file again");

/// Of a picture that is to be shown another way round than it is stored, as TIFF and EXIF count it; empty for the
/// others.
std::string orientationNotice(int orientation);

/// Throws FileError.
std::unique_ptr<PictureFile> openTiff(const std::string& path);

} // namespace pellucid
