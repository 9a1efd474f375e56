// The data of arrays in VTK's XML files: behind a header of their own, plain or in base64, packed in blocks or not.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "volume/formats/block_codec.h"
#include "volume/formats/byte_source.h"

namespace pellucid {

/// What to do about an array that has not the bytes that its header asks for.
inline constexpr const char* kCheckArray = "check the extent and the type of the array, or copy the file again";

/// The bytes of base64 digits; blanks are skipped, digits may follow padding, anything else ends the data.
class Base64Bytes final : public ByteSource {
public:
    Base64Bytes(const std::string& path, std::uint64_t start, const JobControl& job) : m_digits(path, start, job) {}
    std::size_t read(char* to, std::size_t count) override;

private:
    bool decodeFour();
    FileCharacters m_digits;
    std::string m_ready;
    std::size_t m_readyAt = 0;
};

/// Packed blocks one after the other, each of a known size packed and unpacked.
class PackedBlocks final : public ByteSource {
public:
    PackedBlocks(std::unique_ptr<ByteSource> from, VtkPacking packing, std::vector<PackedBlock> blocks);
    /// Fewer bytes where a block is damaged or yields another number of bytes than it should.
    std::size_t read(char* to, std::size_t count) override;
    /// Does not unpack the blocks that it leaves out as a whole, nor look whether they are damaged.
    bool skip(std::uint64_t count) override;

private:
    bool beginBlock();
    bool endBlock();
    bool fill();
    bool step(BlockCodec::Output& out);
    std::unique_ptr<ByteSource> m_from;
    std::unique_ptr<BlockCodec> m_codec;
    std::vector<PackedBlock> m_blocks;
    std::size_t m_block = 0; // that is being unpacked
    std::uint64_t m_packedLeft = 0, m_unpackedLeft = 0;
    std::vector<unsigned char> m_packed;
    BlockCodec::Input m_in; // what is left of m_packed
    bool m_ended = true, m_failed = false;
};

/// Where the data of one array begin, with their header, and how they are stored.
struct VtkData {
    std::string path;
    std::uint64_t start = 0; ///< byte of the file
    bool base64 = false;
    VtkPacking packing = VtkPacking::None;
    bool bigEndian = false;
    int headerBytes = 4;     ///< of a number in the header: 4 or 8
    std::uint64_t bytes = 0; ///< that the array needs, unpacked
};

/// Throws FileError unless the header announces data.bytes and the file holds them. Returns where the data begin that
/// are neither base64 nor compressed.
std::uint64_t requireVtkBytes(const VtkData& data, const JobControl& job);

/// The bytes behind the header. The caller has looked at it by requireVtkBytes(). `job` must outlive it.
std::unique_ptr<ByteSource> openVtkData(const VtkData& data, const JobControl& job);

} // namespace pellucid
