// Two pieces of a VTK image of 2 x 3 x 1 points, for files that name them.
#pragma once

#include "fuzz_input.h"
#include "volume/vtk_files.h"

namespace pellucid::fuzz {

struct VtkPieces : InputFolder {
    VtkPieces() {
        const std::string image = "WholeExtent=\"0 1 0 2 0 0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
        const auto piece = [&](const char* extent, const char* values) {
            return test::vti({}, {{"type=\"UInt8\" Name=\"v\"", values, ""}}, "", image, extent);
        };
        keep("a.vti", piece("0 1 0 1 0 0", "1 2 3 4"));
        keep("b.vti", piece("0 1 1 2 0 0", "3 4 5 6"));
    }
};

} // namespace pellucid::fuzz
