// NetCDF in its classic form.
#include "foreign/arrays/array_volume.h"
#include "foreign_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    if (size < 4) return 0; // what tells the format, before it gets here
    s_folder.with(data, size, ".nc", [](const std::string& path) {
        succeeds([&] { readForeign(ArrayVolume(openNetCdf(path, [](std::uint64_t) {}), path, "")); });
    });
    return 0;
}
