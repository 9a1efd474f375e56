#include "base/shared_work.h"

#include <cstdint>

#include "base/byte_stream.h"

namespace pellucid {

std::vector<std::vector<double>> madeTogether(const SharedWork& work, std::size_t count,
                                              const std::function<std::vector<double>(std::size_t)>& make) {
    std::vector<std::vector<double>> made(count);
    for (std::size_t i = work.part; i < count; i += work.parts) made[i] = make(i);
    if (work.parts == 1) return made;
    std::vector<std::byte> mine;
    for (std::size_t i = work.part; i < count; i += work.parts) {
        appendBytes(mine, static_cast<std::uint64_t>(made[i].size()));
        appendBytes(mine, std::span<const double>(made[i]));
    }
    const auto all = work.gather(mine);
    for (std::size_t part = 0; part < work.parts; ++part) {
        ByteReader reader(all.at(part));
        for (std::size_t i = part; i < count; i += work.parts) {
            made[i].resize(reader.take<std::uint64_t>());
            reader.take(std::span<double>(made[i]));
        }
    }
    return made;
}

} // namespace pellucid
