// VTK's legacy files, written out and binary.
#include "volume_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    openVolume(s_folder, data, size, ".vtk");
    return 0;
}
