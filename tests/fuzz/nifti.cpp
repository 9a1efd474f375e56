// NIfTI: plain, and headers of data in another file (those of magic ni1 and ni2).
#include <cstring>

#include "data_beside.h"
#include "volume_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

bool isOfPair(const std::uint8_t* data, std::size_t size) {
    return (size >= 348 && std::memcmp(data + 344, "ni1", 3) == 0) ||
           (size >= 8 && std::memcmp(data + 4, "ni2", 3) == 0);
}

/// Data of the name of the header, 400 bytes, for as long as this is there.
class Image {
public:
    explicit Image(const std::string& header) : m_path(std::filesystem::path(header).replace_extension(".img")) {
        std::ofstream(m_path, std::ios::binary) << std::string(400, 'x');
    }
    ~Image() { std::filesystem::remove(m_path); }
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;

private:
    std::filesystem::path m_path;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    if (!isOfPair(data, size)) {
        openVolume(s_folder, data, size, ".nii");
        return 0;
    }
    s_folder.with(data, size, ".hdr", [](const std::string& path) {
        const Image image(path);
        VolumeSource source;
        source.path = path;
        openVolume(source);
    });
    return 0;
}
