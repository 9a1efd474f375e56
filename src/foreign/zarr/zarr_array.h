// Arrays of Zarr, versions 2 and 3, in folders: what their metadata say, and the values of boxes. Runs in
// pellucid-array-reader only.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "foreign/foreign_volume.h"
#include "foreign/zarr/zarr_codecs.h"

namespace pellucid {

/// The metadata of a node of a hierarchy, whichever version it has.
struct ZarrNode {
    std::string file; ///< that the metadata are from
    int version = 2;
    nlohmann::json metadata;   ///< of an array; null for a group
    nlohmann::json attributes; ///< an object
    bool isArray() const { return !metadata.is_null(); }
};
/// Empty where the folder is none. Throws FileError for metadata that cannot be read.
std::optional<ZarrNode> zarrNodeAt(const std::string& folder);

/// Indices lo … hi − 1 along each axis of an array.
struct ZarrBox {
    std::vector<std::int64_t> lo, hi;
};

class ZarrArray {
public:
    /// Throws FileError for what is not supported, or cannot be.
    ZarrArray(const std::string& folder, const ZarrNode& node);

    const std::vector<std::int64_t>& shape() const { return m_shape; } ///< first axis slowest
    const std::vector<std::int64_t>& chunk() const { return m_chunk; } ///< indices of a chunk along each axis
    const std::vector<std::string>& names() const { return m_names; }  ///< of the axes; empty: not given
    ValueType type() const { return m_type; }                          ///< of the values that read() gives
    std::uint64_t chunkBytes() const;                                  ///< unpacked
    const std::string& file() const { return m_file; }                 ///< of its metadata

    /// Writes the values of a box: those of index i at Σ (i[a] − lo[a])·strides[a], counted in values.
    void read(const ZarrBox& box, std::span<const std::int64_t> strides, std::span<std::byte> to,
              const BeforeFile& before, const JobControl& job) const;

private:
    using Index = std::vector<std::int64_t>;
    void readVersion2(const JsonValue& metadata);
    void readVersion3(const JsonValue& metadata);
    void readType(const std::string& name, const JsonValue& at);
    void readCodecs(const JsonValue& codecs, bool inShard);
    void readShards(const JsonValue& settings);
    void readFill(const JsonValue& metadata);
    void requireSizes(const JsonValue& at) const;
    std::string nameOf(const Index& chunk) const;
    /// The unpacked bytes of a chunk; empty where it is not stored.
    std::vector<char> chunkAt(const Index& chunk, const BeforeFile& before) const;
    std::vector<char> storedInShard(const Index& chunk, std::string& path, const BeforeFile& before) const;
    void convert(std::vector<char>& values) const;
    template <class T>
    void copy(const std::vector<char>& values, const Index& first, const ZarrBox& box,
              std::span<const std::int64_t> strides, T* to) const;

    std::string m_folder, m_file;
    Index m_shape, m_chunk;
    std::vector<std::string> m_names;
    std::vector<std::size_t> m_order; ///< axes of a chunk as they are stored, slowest first
    ValueType m_type = ValueType::U8;
    bool m_isHalf = false; ///< stored as floats of 16 bits
    bool m_bigEndian = false;
    std::vector<ZarrCodec> m_codecs; ///< in the order in which they are undone
    double m_fill = 0;
    std::string m_prefix, m_separator = ".";
    Index m_shard;                        ///< indices of a shard along each axis; empty: each chunk is a file
    std::vector<ZarrCodec> m_indexCodecs; ///< of the table of a shard
    bool m_indexAtEnd = true;
};

} // namespace pellucid
