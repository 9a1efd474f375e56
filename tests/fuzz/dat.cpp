// Headers of Voreen and Inviwo beside a file of voxels.
#include "data_beside.h"
#include "volume_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const DataBeside s_folder;
    openVolume(s_folder, data, size, ".dat");
    return 0;
}
