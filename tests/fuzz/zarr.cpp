// Zarr, versions 2 and 3: the metadata of a folder and of an array in it, and the bytes of its first chunk or shard. An
// input is these three, each but the last ended by a line "%%"; metadata go into zarr.json where they have a
// "node_type", else into .zattrs and .zarray.
#include "foreign/zarr/ome_zarr.h"
#include "foreign_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

namespace fs = std::filesystem;

std::string takePart(std::string& text) {
    constexpr std::string_view kEnd = "\n%%\n";
    const std::size_t end = text.find(kEnd);
    std::string part = text.substr(0, end);
    text = end == std::string::npos ? std::string() : text.substr(end + kEnd.size());
    return part;
}

class ZarrFolder {
public:
    explicit ZarrFolder(std::string input) {
        const std::string group = takePart(input), array = takePart(input);
        fs::create_directories(m_folder.path("0/c/0/0"));
        fs::create_directories(m_folder.path("0/0/0"));
        m_folder.write(has3(group) ? "zarr.json" : ".zattrs", group);
        m_folder.write(has3(array) ? "0/zarr.json" : "0/.zarray", array);
        for (const char* chunk : {"0/0.0.0", "0/0/0/0", "0/c/0/0/0"}) m_folder.write(chunk, input);
    }
    std::string path() const { return m_folder.path(""); }

private:
    static bool has3(const std::string& metadata) { return metadata.find("\"node_type\"") != std::string::npos; }
    test::TempFolder m_folder;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ZarrFolder folder(fuzz::textOf(data, size));
    succeeds([&] { readForeign(OmeZarr(folder.path(), "", [](std::uint64_t) {})); });
    return 0;
}
