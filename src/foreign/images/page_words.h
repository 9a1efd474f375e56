// What the texts in TIFF files say of their pages: ImageJ's, and OME-XML.
#pragma once

#include <string>

#include "volume/grid.h"

namespace pellucid {

/// How the pages of a file follow each other, and how far pixels are apart.
struct PageOrder {
    /// Pages vary fastest along the first letter: z (slices), c (channels), t (time steps).
    std::string axes = "z";
    int slices = 0, channels = 1, steps = 1; ///< slices 0: as many as there are pages left
    int images = 0; ///< of ImageJ, which writes one directory alone for stacks of 4 GB and more; 0: it does not say
    Vec3 spacing{1, 1, 1};
    double stepSeconds = 0; ///< from step to step; 0: not known
    std::string software;   ///< "ImageJ", "OME"; empty: neither
};

/// `description`: of the first page. `pixelsPerUnit`: along x and y, as TIFF has them; 0 where it does not say.
PageOrder pageOrderIn(const std::string& description, double pixelsPerUnitX, double pixelsPerUnitY);

} // namespace pellucid
