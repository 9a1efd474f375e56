// What the texts in TIFF files say of their pages: ImageJ's, and OME-XML.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/length_unit.h"
#include "foreign/images/picture_file.h"
#include "volume/grid.h"

namespace pellucid {

/// Pages of one file that are looked at: each costs a header, and a chain of pages may lead back.
inline constexpr int kMostPages = 100'000;

/// What a TIFF file says on its first page.
struct FirstPage {
    std::string description;
    double pixelsPerUnitX = 0, pixelsPerUnitY = 0; ///< as TIFF has them; 0: it does not say
    PageShape shape;
    std::string fileName;  ///< without its folder
    std::size_t image = 0; ///< of imagesNamedIn(): the one that is meant
};

/// An image that OME-XML describes.
struct ImageInFile {
    std::string name;      ///< which no other image has
    std::string details;   ///< "512 × 512 × 20, u16"
    std::string elsewhere; ///< the files that it is in, where it has no page in this one; empty: it has
    int firstPage = 0;     ///< in this file
};

/// All that OME-XML on the first page describes; none where there is no OME-XML.
std::vector<ImageInFile> imagesNamedIn(const FirstPage& page);

/// How the pages of a file follow each other, and how far pixels are apart.
struct PageOrder {
    static constexpr int kElsewhere = -1;

    /// Pictures vary fastest along the first letter: z (slices), c (channels), t (time steps).
    std::string axes = "z";
    int slices = 0, channels = 1, steps = 1; ///< slices 0: as many as there are pages left
    /// The page of each picture in the order of `axes`; kElsewhere: not in this file. Empty: the pages are the
    /// pictures, in this order.
    std::vector<int> pages;
    int elsewhere = 0; ///< pictures in other files
    int images = 0;    ///< of ImageJ, which writes one directory alone for stacks of 4 GB and more; 0: it does not say
    Vec3 spacing{1, 1, 1};
    LengthUnit lengthUnit = LengthUnit::Unknown; ///< of `spacing`
    double stepSeconds = 0;                      ///< from step to step; 0: not known
    std::optional<ValueScaling> scaling;         ///< empty: values are as stored
    std::string software;                        ///< "ImageJ", "OME"; empty: neither
    std::vector<std::string> notices;

    int sizeAlong(char axis) const { return axis == 'z' ? slices : axis == 'c' ? channels : steps; }
};

PageOrder pageOrderIn(const FirstPage& page);

/// What a file says that is one slice of several.
struct SliceMetadata {
    Vec3 spacing{1, 1, 1}; ///< 1 where it does not say
    LengthUnit lengthUnit = LengthUnit::Unknown;
    bool isApartKnown = false; ///< whether it says how far slices are apart
    std::optional<ValueScaling> scaling;
    std::vector<std::string> notices;
};

SliceMetadata sliceMetadataIn(const FirstPage& page);

} // namespace pellucid
