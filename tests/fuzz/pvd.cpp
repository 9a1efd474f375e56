// Collections of VTK files over time, here of a.vti and b.vti; their frames are listed, too.
#include "volume/series.h"
#include "volume_input.h"
#include "vtk_pieces.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const VtkPieces s_folder;
    s_folder.with(data, size, ".pvd", [](const std::string& path) {
        VolumeSource source;
        source.path = path;
        openVolume(source);
        succeeds([&] { require(!listSeries(source).frames.empty(), "a series has frames"); });
    });
    return 0;
}
