// VTK image data whose pieces, a.vti and b.vti, are files of their own.
#include "volume_input.h"
#include "vtk_pieces.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const VtkPieces s_folder;
    openVolume(s_folder, data, size, ".pvti");
    return 0;
}
