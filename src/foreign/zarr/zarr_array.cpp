#include "foreign/zarr/zarr_array.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "base/text.h"
#include "volume/formats/file_check.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostMetadata = 64u << 20; ///< bytes
constexpr std::size_t kMostAxes = 16;
constexpr std::uint64_t kMostChunk = std::uint64_t{1} << 30; ///< bytes
constexpr std::int64_t kMostInShard = std::int64_t{1} << 40; ///< chunks: the bytes of their table can be counted

/// `text` with the numbers that JSON has no word for in quotes, as Zarr 3 has them: Python writes them without.
std::string withQuotedNumbers(const std::string& text) {
    std::string quoted;
    bool isInText = false;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t length = isInText && text[at] == '\\' ? 2 : 1;
        if (text[at] == '"') isInText = !isInText;
        bool isNumber = false;
        for (const std::string_view word : {"NaN", "Infinity", "-Infinity"})
            if (!isInText && text.compare(at, word.size(), word) == 0) {
                isNumber = true;
                length = word.size();
            }
        const std::string part = text.substr(at, length);
        quoted += isNumber ? '"' + part + '"' : part;
        at += length;
    }
    return quoted;
}

json jsonAt(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text;
    for (std::vector<char> piece(65536);
         in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0;) {
        text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
        if (text.size() > kMostMetadata) throw FileError("the metadata are too long", path, "correct the file");
    }
    json document = json::parse(text, nullptr, false);
    if (document.is_discarded()) document = json::parse(withQuotedNumbers(text), nullptr, false);
    if (!document.is_object()) throw FileError("the metadata are no JSON object", path, "copy or write the file again");
    return document;
}

bool isFile(const std::string& path) {
    std::error_code ec;
    return fs::is_regular_file(path, ec);
}

std::vector<std::int64_t> sizesIn(const JsonValue& list) {
    std::vector<std::int64_t> sizes;
    for (const JsonValue& size : list.items()) {
        if (sizes.size() >= kMostAxes) list.fail("there are too many axes");
        sizes.push_back(size.integer(1, std::numeric_limits<std::int32_t>::max()));
    }
    return sizes;
}

float floatOfHalf(std::uint16_t half) {
    const int exponent = half >> 10 & 31;
    const float sign = (half & 0x8000u) != 0 ? -1.0f : 1.0f;
    const auto fraction = static_cast<float>(half & 1023u) / 1024.0f;
    if (exponent == 31)
        return fraction == 0 ? sign * std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    return exponent == 0 ? sign * std::ldexp(fraction, -14) : sign * std::ldexp(1.0f + fraction, exponent - 15);
}

/// What stands between the indices in the name of a chunk: another one could lead out of the folder.
std::string separatorIn(const JsonValue& text) {
    const std::string separator = text.text();
    if (separator != "." && separator != "/")
        text.fail("indices in the names of chunks are not separated by '.' or '/'");
    return separator;
}

/// The value of chunks that are not stored.
template <class T>
T fillAs(double fill) {
    if constexpr (std::is_integral_v<T>) {
        if (std::isnan(fill)) return 0;
        if (fill >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
        if (fill <= static_cast<double>(std::numeric_limits<T>::lowest())) return std::numeric_limits<T>::lowest();
    }
    return static_cast<T>(fill);
}

/// Goes to the next index of a box, the last axis first; false after the last one.
bool advance(std::vector<std::int64_t>& index, const std::vector<std::int64_t>& lo,
             const std::vector<std::int64_t>& hi) {
    for (std::size_t a = index.size(); a-- > 0;) {
        if (++index[a] < hi[a]) return true;
        index[a] = lo[a];
    }
    return false;
}

} // namespace

std::optional<ZarrNode> zarrNodeAt(const std::string& folder) {
    ZarrNode node;
    node.attributes = json::object();
    if (const std::string file = folder + "/zarr.json"; isFile(file)) {
        json document = jsonAt(file);
        node.file = file;
        node.version = 3;
        if (document.contains("attributes") && document["attributes"].is_object())
            node.attributes = document["attributes"];
        if (document.contains("node_type") && document["node_type"] == "array") node.metadata = std::move(document);
        return node;
    }
    const std::string array = folder + "/.zarray", group = folder + "/.zgroup", attributes = folder + "/.zattrs";
    if (!isFile(array) && !isFile(group) && !isFile(attributes)) return {};
    node.file = isFile(array) ? array : isFile(attributes) ? attributes : group;
    if (isFile(array)) node.metadata = jsonAt(array);
    if (isFile(attributes)) node.attributes = jsonAt(attributes);
    return node;
}

ZarrArray::ZarrArray(const std::string& folder, const ZarrNode& node) : m_folder(folder), m_file(node.file) {
    PELLUCID_CHECK(node.isArray());
    const JsonValue metadata(node.metadata, node.file);
    m_shape = sizesIn(metadata["shape"]);
    m_order.resize(m_shape.size());
    std::iota(m_order.begin(), m_order.end(), 0u);
    if (node.version == 2) {
        readVersion2(metadata);
        if (const auto names = node.attributes.find("_ARRAY_DIMENSIONS");
            names != node.attributes.end() && names->is_array())
            for (const json& name : *names) m_names.push_back(name.is_string() ? name.get<std::string>() : "");
    } else {
        readVersion3(metadata);
    }
    if (m_names.size() != m_shape.size()) m_names.clear();
    requireSizes(metadata);
    readFill(metadata);
}

void ZarrArray::readVersion2(const JsonValue& metadata) {
    metadata["zarr_format"].integer(2, 2);
    m_chunk = sizesIn(metadata["chunks"]);
    if (!metadata["dtype"].json().is_string())
        metadata["dtype"].fail("records are not supported", "write each field as an array of its own");
    const std::string dtype = metadata["dtype"].text();
    m_bigEndian = dtype.starts_with('>');
    readType(dtype.empty() ? dtype : dtype.substr(1), metadata["dtype"]);
    if (metadata.has("order") && metadata["order"].text() == "F") std::ranges::reverse(m_order);
    if (metadata.has("dimension_separator")) m_separator = separatorIn(metadata["dimension_separator"]);
    if (metadata.has("filters") && metadata["filters"].json().is_array() && !metadata["filters"].items().empty())
        metadata["filters"].fail("filters of chunks are not supported", "write the array without them");
    if (metadata.has("compressor") && !metadata["compressor"].json().is_null())
        m_codecs.push_back(zarrCodecNamed(metadata["compressor"]["id"].text(), metadata["compressor"]));
}

void ZarrArray::readVersion3(const JsonValue& metadata) {
    const JsonValue grid = metadata["chunk_grid"];
    if (grid["name"].text() != "regular")
        grid.fail("chunks of different sizes are not supported", "write the array with a regular grid of chunks");
    m_chunk = sizesIn(grid["configuration"]["chunk_shape"]);
    readType(metadata["data_type"].text(), metadata["data_type"]);
    const JsonValue keys = metadata["chunk_key_encoding"];
    const bool isDefault = keys["name"].text() == "default";
    if (!isDefault && keys["name"].text() != "v2") keys.fail("the names of the chunks are of a kind that is not known");
    m_prefix = isDefault ? "c" : "";
    m_separator = isDefault ? "/" : ".";
    if (keys.has("configuration") && keys["configuration"].has("separator"))
        m_separator = separatorIn(keys["configuration"]["separator"]);
    readCodecs(metadata["codecs"], false);
    if (metadata.has("dimension_names") && metadata["dimension_names"].json().is_array())
        for (const JsonValue& name : metadata["dimension_names"].items())
            m_names.push_back(name.json().is_string() ? name.text() : "");
}

void ZarrArray::readCodecs(const JsonValue& codecs, bool inShard) {
    for (const JsonValue& codec : codecs.items()) {
        const std::string name = codec["name"].text();
        if (name == "bytes") {
            m_bigEndian = codec.has("configuration") && codec["configuration"].has("endian") &&
                          codec["configuration"]["endian"].text() == "big";
        } else if (name == "transpose") {
            const JsonValue order = codec["configuration"]["order"];
            std::vector<std::size_t> axes;
            for (const JsonValue& axis : order.items(m_shape.size()))
                axes.push_back(m_order.at(
                    static_cast<std::size_t>(axis.integer(0, static_cast<std::int64_t>(m_shape.size()) - 1))));
            m_order = axes;
            std::ranges::sort(axes);
            if (std::ranges::adjacent_find(axes) != axes.end()) order.fail("an axis stands there twice");
        } else if (name == "sharding_indexed") {
            if (inShard) codec.fail("shards in shards are not supported", "write the array without them");
            readShards(codec["configuration"]);
        } else {
            m_codecs.insert(m_codecs.begin(), zarrCodecNamed(name, codec));
        }
    }
}

void ZarrArray::readShards(const JsonValue& settings) {
    m_shard = m_chunk;
    m_chunk = sizesIn(settings["chunk_shape"]);
    if (m_chunk.size() != m_shard.size()) settings.fail("chunks and shards have different numbers of axes");
    std::int64_t left = kMostInShard;
    for (std::size_t a = 0; a < m_chunk.size(); ++a) {
        if (m_shard[a] % m_chunk[a] != 0) settings.fail("the chunks do not fill their shard");
        left /= m_shard[a] / m_chunk[a];
    }
    if (left == 0) settings.fail("there are too many chunks in a shard", "write the array in larger chunks");
    m_indexAtEnd = !settings.has("index_location") || settings["index_location"].text() == "end";
    for (const JsonValue& codec : settings["index_codecs"].items())
        if (const std::string name = codec["name"].text(); name != "bytes") {
            m_indexCodecs.push_back(zarrCodecNamed(name, codec));
            if (m_indexCodecs.back() != ZarrCodec::Crc32c)
                codec.fail("the table of a shard is packed, which is not supported", "write the array again");
        }
    readCodecs(settings["codecs"], true);
}

void ZarrArray::readType(const std::string& name, const JsonValue& at) {
    struct Type {
        const char *two, *three;
        ValueType type;
    };
    constexpr Type kTypes[] = {
        {"b1", "bool", ValueType::U8},     {"u1", "uint8", ValueType::U8},    {"i1", "int8", ValueType::I8},
        {"u2", "uint16", ValueType::U16},  {"i2", "int16", ValueType::I16},   {"u4", "uint32", ValueType::U32},
        {"i4", "int32", ValueType::I32},   {"u8", "uint64", ValueType::U64},  {"i8", "int64", ValueType::I64},
        {"f2", "float16", ValueType::F32}, {"f4", "float32", ValueType::F32}, {"f8", "float64", ValueType::F64}};
    for (const Type& type : kTypes)
        if (name == type.two || name == type.three) {
            m_type = type.type;
            m_isHalf = type.two == std::string("f2");
            return;
        }
    at.fail("values of the type " + inQuotes(name) + " are not supported", "use integers or floats");
}

void ZarrArray::readFill(const JsonValue& metadata) {
    if (!metadata.has("fill_value")) return;
    const json& fill = metadata["fill_value"].json();
    if (fill.is_number()) m_fill = fill.get<double>();
    if (fill.is_boolean()) m_fill = fill.get<bool>() ? 1 : 0;
    if (!fill.is_string()) return;
    const std::string text = fill.get<std::string>();
    const double infinity = std::numeric_limits<double>::infinity();
    if (text == "NaN") m_fill = std::numeric_limits<double>::quiet_NaN();
    if (text == "Infinity" || text == "-Infinity") m_fill = text.front() == '-' ? -infinity : infinity;
}

void ZarrArray::requireSizes(const JsonValue& at) const {
    if (m_shape.empty() || m_shape.size() != m_chunk.size())
        at.fail("an array of " + std::to_string(m_shape.size()) + " axes with chunks of " +
                std::to_string(m_chunk.size()) + " is no volume");
    const std::uint64_t chunk = valueCount(m_file, m_chunk, 8) * bytesPerValue(m_type);
    std::uint64_t needed = bytesPerValue(m_type); // of a chunk, by what the array has of it
    for (std::size_t a = 0; a < m_shape.size(); ++a)
        needed *= static_cast<std::uint64_t>(std::min(2 * m_shape[a], m_chunk[a]));
    if (chunk > kMostChunk || chunk > std::max<std::uint64_t>(64u << 20, needed))
        at.fail("its chunks are larger than any memory should be asked for (" + std::to_string(chunk >> 20) + " MiB)",
                "write the array in smaller chunks");
}

std::uint64_t ZarrArray::chunkBytes() const { return valueCount(m_file, m_chunk, 8) * bytesPerValue(m_type); }

std::string ZarrArray::nameOf(const Index& chunk) const {
    std::string name = m_prefix;
    for (const std::int64_t index : chunk) name += (name.empty() ? "" : m_separator) + std::to_string(index);
    return m_folder + "/" + name;
}

namespace {

/// Bytes of a file; empty where there is no such file. Throws FileError where they are not all there.
std::vector<char> bytesAt(const std::string& path, std::uint64_t start, std::optional<std::uint64_t> count,
                          const BeforeFile& before) {
    std::error_code ec;
    const std::uint64_t size = fs::file_size(path, ec);
    if (ec) return {};
    const std::uint64_t wanted = count.value_or(size);
    if (start > size || wanted > size - start)
        throw FileError("this file is shorter than its own table says", path, "copy the data again");
    before(wanted);
    std::vector<char> bytes(static_cast<std::size_t>(wanted));
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(start));
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!in) throw FileError("this file cannot be read", path, "check its permissions, or copy it again");
    return bytes;
}

} // namespace

std::vector<char> ZarrArray::storedInShard(const Index& chunk, std::string& path, const BeforeFile& before) const {
    Index shard(chunk.size());
    std::uint64_t inner = 0, all = 1;
    for (std::size_t a = 0; a < chunk.size(); ++a) {
        const std::int64_t per = m_shard[a] / m_chunk[a];
        shard[a] = chunk[a] / per;
        inner = inner * static_cast<std::uint64_t>(per) + static_cast<std::uint64_t>(chunk[a] % per);
        all *= static_cast<std::uint64_t>(per);
    }
    path = nameOf(shard);
    const std::uint64_t size = bytesOfFile(path);
    if (size == 0) return {};
    const std::uint64_t table = 16 * all + 4 * m_indexCodecs.size();
    if (table > size) throw FileError("this file is shorter than its own table", path, "copy the data again");
    std::vector<char> index = bytesAt(path, m_indexAtEnd ? size - table : 0, table, before);
    for (const ZarrCodec codec : m_indexCodecs) index = unpacked(codec, index, index.size(), path);
    const auto number = [&](std::uint64_t at) {
        std::uint64_t value = 0;
        for (std::size_t i = 8; i > 0; --i)
            value = value << 8 | static_cast<unsigned char>(index[static_cast<std::size_t>(at) + i - 1]);
        return value;
    };
    const std::uint64_t offset = number(16 * inner), bytes = number(16 * inner + 8);
    if (offset == ~std::uint64_t{0} && bytes == offset) return {};
    return bytesAt(path, offset, bytes, before);
}

void ZarrArray::convert(std::vector<char>& values) const {
    const std::size_t size = m_isHalf ? 2 : static_cast<std::size_t>(bytesPerValue(m_type));
    if (size > 1 && m_bigEndian != (std::endian::native == std::endian::big))
        swapBytes(std::as_writable_bytes(std::span(values)), size);
    if (!m_isHalf) return;
    std::vector<char> floats(2 * values.size());
    for (std::size_t i = 0; i < values.size() / 2; ++i) {
        std::uint16_t half = 0;
        std::memcpy(&half, values.data() + 2 * i, 2);
        const float value = floatOfHalf(half);
        std::memcpy(floats.data() + 4 * i, &value, 4);
    }
    values = std::move(floats);
}

std::vector<char> ZarrArray::chunkAt(const Index& chunk, const BeforeFile& before) const {
    std::string path;
    std::vector<char> bytes;
    if (m_shard.empty()) {
        path = nameOf(chunk);
        bytes = bytesAt(path, 0, {}, before);
    } else {
        bytes = storedInShard(chunk, path, before);
    }
    if (bytes.empty()) return bytes;
    const auto whole = static_cast<std::size_t>(m_isHalf ? chunkBytes() / 2 : chunkBytes());
    before(whole);
    constexpr std::size_t kOfSums = 64; // what checksums add
    for (const ZarrCodec codec : m_codecs) bytes = unpacked(codec, bytes, whole + kOfSums, path);
    if (bytes.size() != whole)
        throw FileError("this chunk has " + std::to_string(bytes.size()) + " bytes, not " + std::to_string(whole), path,
                        "copy the data again");
    convert(bytes);
    return bytes;
}

template <class T>
void ZarrArray::copy(const std::vector<char>& values, const Index& first, const ZarrBox& box,
                     std::span<const std::int64_t> strides, T* to) const {
    const std::size_t axes = m_shape.size();
    Index inChunk(axes), lo(axes), hi(axes); // strides within the chunk; what box and chunk have in common
    std::int64_t stride = 1;
    for (std::size_t n = axes; n-- > 0;) {
        inChunk[m_order[n]] = stride;
        stride *= m_chunk[m_order[n]];
    }
    for (std::size_t a = 0; a < axes; ++a) {
        lo[a] = std::max(box.lo[a], first[a]);
        hi[a] = std::min(box.hi[a], first[a] + m_chunk[a]);
    }
    const T fill = fillAs<T>(m_fill);
    const std::size_t last = axes - 1; // rows along it
    const std::int64_t count = hi[last] - lo[last], toStep = strides[last], fromStep = inChunk[last];
    Index index = lo, rowEnd = hi;
    rowEnd[last] = lo[last] + 1;
    do {
        std::int64_t at = 0, from = 0;
        for (std::size_t a = 0; a < axes; ++a) {
            at += (index[a] - box.lo[a]) * strides[a];
            from += (index[a] - first[a]) * inChunk[a];
        }
        if (values.empty()) {
            for (std::int64_t i = 0; i < count; ++i) to[at + i * toStep] = fill;
        } else if (toStep == 1 && fromStep == 1) {
            std::memcpy(to + at, values.data() + static_cast<std::size_t>(from) * sizeof(T),
                        static_cast<std::size_t>(count) * sizeof(T));
        } else {
            for (std::int64_t i = 0; i < count; ++i)
                std::memcpy(to + at + i * toStep,
                            values.data() + static_cast<std::size_t>(from + i * fromStep) * sizeof(T), sizeof(T));
        }
    } while (advance(index, lo, rowEnd));
}

void ZarrArray::read(const ZarrBox& box, std::span<const std::int64_t> strides, std::span<std::byte> to,
                     const BeforeFile& before, const JobControl& job) const {
    const std::size_t axes = m_shape.size();
    Index lo(axes), hi(axes); // of chunks
    std::uint64_t chunks = 1, done = 0;
    for (std::size_t a = 0; a < axes; ++a) {
        PELLUCID_CHECK(box.lo[a] >= 0 && box.lo[a] < box.hi[a] && box.hi[a] <= m_shape[a]);
        lo[a] = box.lo[a] / m_chunk[a];
        hi[a] = (box.hi[a] - 1) / m_chunk[a] + 1;
        chunks *= static_cast<std::uint64_t>(hi[a] - lo[a]);
    }
    Index chunk = lo, first(axes);
    do {
        const std::vector<char> values = chunkAt(chunk, before);
        for (std::size_t a = 0; a < axes; ++a) first[a] = chunk[a] * m_chunk[a];
        withType(m_type, [&](auto zero) {
            using T = decltype(zero);
            copy<T>(values, first, box, strides, reinterpret_cast<T*>(to.data()));
        });
        job.throwIfStopped();
        job.report(static_cast<double>(++done) / static_cast<double>(chunks));
    } while (advance(chunk, lo, hi));
}

} // namespace pellucid
