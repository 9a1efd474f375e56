// A packed stream as input.
#pragma once

#include <vector>

#include "fuzz_input.h"
#include "volume/formats/byte_source.h"

namespace pellucid::fuzz {

/// Unpacks all of it in pieces of odd sizes, up to 64 MiB. `each(piece)` gets them in their order.
template <class Each>
void unpackAll(UnpackedBytes& bytes, const Each& each) {
    std::vector<char> piece(70'001);
    std::uint64_t total = 0;
    for (std::size_t wanted = 1; total < (64u << 20); wanted = std::min(piece.size(), wanted * 3)) {
        const std::size_t got = bytes.read(piece.data(), wanted);
        require(got <= wanted, "no more is read than is asked for");
        each(std::string_view(piece.data(), got));
        total += got;
        require(bytes.decoded() == total, "what has come out is counted");
        require(bytes.soundBytes() <= total, "sound bytes have come out");
        if (got == wanted) continue;
        require(bytes.end() != UnpackedBytes::End::None, "a stream that ends says how");
        return;
    }
}

} // namespace pellucid::fuzz
