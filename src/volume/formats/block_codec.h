// How one block of packed data unpacks: by zlib, LZ4 or LZMA, each with limits of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace pellucid {

/// How the arrays of a file of VTK are packed.
enum class VtkPacking { None, ZLib, Lz4, Lzma };

/// A block of known sizes.
struct PackedBlock {
    std::uint64_t packed, unpacked; ///< bytes
};

/// Unpacks one block after the other, each in pieces of any size.
class BlockCodec {
public:
    enum class State { More, Ended, Damaged };
    /// What is left of a piece; decode() moves both.
    struct Input {
        const unsigned char* next = nullptr;
        std::size_t left = 0;
    };
    struct Output {
        unsigned char* next = nullptr;
        std::size_t left = 0;
    };

    virtual ~BlockCodec() = default;
    /// False where a block of these sizes is not to be unpacked.
    virtual bool begin(const PackedBlock& block) = 0;
    /// Goes on as far as input and output allow. Ended: all of the block has come out, and its sum is right.
    virtual State decode(Input& in, Output& out) = 0;

    /// `packing` is one of the three.
    static std::unique_ptr<BlockCodec> of(VtkPacking packing);
    /// So many unpacked bytes a packed one stands for at most.
    static std::uint64_t mostPerByte(VtkPacking packing);
};

/// Blocks of LZ4 are unpacked as a whole: larger ones are refused.
inline constexpr std::uint64_t kMostLz4Block = 256u << 20;

} // namespace pellucid
