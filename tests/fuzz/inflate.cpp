// Streams of gzip, also of several members, and of zlib: unpacked from one end to the other, and from the places of an
// index.
#include "unpacked_input.h"
#include "volume/formats/inflate_index.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

/// Bytes from `skip` on, by the index, are those of the stream.
void requireSameBytes(const InflateIndex& index, const std::string& all, std::uint64_t skip, const JobControl& job) {
    const auto bytes = index.bytes(job);
    require(bytes->skip(skip), "bytes that are there can be left out");
    std::string some(std::min<std::uint64_t>(all.size() - skip, 1000), 0);
    require(bytes->read(some.data(), some.size()) == some.size(), "bytes that are there can be read");
    require(all.compare(skip, some.size(), some) == 0, "bytes are the same from every place");
}

void unpack(const std::string& path, bool zlib) {
    const JobControl job;
    std::string all;
    InflatedBytes bytes(path, 0, zlib, job);
    unpackAll(bytes, [&](std::string_view piece) { all += piece; });
    InflateIndex index(path, 0, zlib);
    std::uint64_t whole = 0;
    if (!succeeds([&] { whole = index.requireWhole(job); })) {
        require(bytes.end() != UnpackedBytes::End::Whole || bytes.soundBytes() == 0, "what is whole is accepted");
        return;
    }
    if (bytes.end() == UnpackedBytes::End::None) return; // too much to go through
    require(bytes.end() == UnpackedBytes::End::Whole, "what is accepted is whole");
    require(whole == all.size() && bytes.soundBytes() == whole, "all that is unpacked is sound");
    for (const std::uint64_t skip : {whole, whole / 2, whole / 7, std::uint64_t{0}})
        requireSameBytes(index, all, skip, job);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    s_folder.with(data, size, ".gz", [](const std::string& path) {
        unpack(path, false);
        unpack(path, true);
    });
    return 0;
}
