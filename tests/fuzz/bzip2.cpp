// Streams of bzip2, also several one after the other.
#include "unpacked_input.h"
#include "volume/formats/bzip2_bytes.h"
#include "volume/formats/file_check.h"

using namespace pellucid;
using namespace pellucid::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".bz2", [](const std::string& path) {
        const JobControl job;
        Bunzipped bytes(path, 0, job);
        unpackAll(bytes, [](std::string_view) {});
        if (bytes.end() != UnpackedBytes::End::Whole) return;
        require(bytes.soundBytes() == bytes.decoded(), "all of a whole stream is sound");
        Bunzipped again(path, 0, job);
        succeeds([&] { require(requireSoundToEnd(again, 1, path) == bytes.decoded(), "it is as long again"); });
    });
    return 0;
}
