// NIfTI in gzip. An input that is not gzip is packed first: few changes of packed bytes come to more than a checksum.
#include "volume/volume_files.h"
#include "volume_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    const std::string input = fuzz::textOf(data, size);
    const std::string packed = input.starts_with("\x1f\x8b") ? input : test::gzipped(input);
    openVolume(s_folder, reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size(), ".nii.gz");
    return 0;
}
