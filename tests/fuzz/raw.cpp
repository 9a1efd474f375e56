// Headerless data: a line with the layout and, where they are wanted, bytes to skip; then the file, which may be gzip.
#include "base/text.h"
#include "volume_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

RawLayout layoutFrom(const std::string& line) {
    const std::vector<std::string> words = splitWords(line);
    RawLayout layout = parseRawLayout(words.empty() ? line : words[0]);
    std::int64_t skip = 0;
    if (words.size() > 1 && parseNumber(words[1], skip)) layout.skipBytes = static_cast<std::uint64_t>(skip);
    return layout;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const InputFolder s_folder;
    const std::size_t line = std::min(fuzz::textOf(data, size).find('\n'), size);
    VolumeSource source;
    if (!succeeds([&] { source.raw = layoutFrom(fuzz::textOf(data, line)); }) || line == size) return 0;
    s_folder.with(data + line + 1, size - line - 1, ".raw", [&](const std::string& path) {
        source.path = path;
        openVolume(source);
        source.frames = FrameRange{};
        succeeds([&] { require(contentsOf(source).steps >= 1, "a file has a step"); });
    });
    return 0;
}
