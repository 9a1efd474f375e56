// The classic form of NetCDF ("NetCDF Classic Format Specification", version 1.1, with the 64-bit data of CDF-5). By
// our own code: libnetcdf 4.9 says nothing where a file is cut off, and gives zeros.
#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <map>

#include "base/text.h"
#include "foreign/arrays/array_file.h"

namespace pellucid {

namespace {

constexpr const char* kCopyAgain = "the file is damaged or cut off: copy it again";
/// Of an attribute: longer ones are passed over.
constexpr std::uint64_t kMostAttribute = 1u << 20;

enum class NcType { Byte = 1, Char, Short, Int, Float, Double, UByte, UShort, UInt, Int64, UInt64 };

std::optional<ValueType> valueTypeOf(NcType type) {
    switch (type) {
    case NcType::Byte:
        return ValueType::I8;
    case NcType::Char:
        return {};
    case NcType::Short:
        return ValueType::I16;
    case NcType::Int:
        return ValueType::I32;
    case NcType::Float:
        return ValueType::F32;
    case NcType::Double:
        return ValueType::F64;
    case NcType::UByte:
        return ValueType::U8;
    case NcType::UShort:
        return ValueType::U16;
    case NcType::UInt:
        return ValueType::U32;
    case NcType::Int64:
        return ValueType::I64;
    case NcType::UInt64:
        return ValueType::U64;
    }
    return {};
}

std::uint64_t bytesPer(NcType type) {
    const auto value = valueTypeOf(type);
    return value ? bytesPerValue(*value) : 1;
}

/// Numbers of the file are big endian.
void toNative(std::span<std::byte> bytes, std::uint64_t width) {
    if (std::endian::native == std::endian::little) swapBytes(bytes, width);
}

/// A header, part by part.
class Header {
public:
    explicit Header(const std::string& path) : m_in(path, std::ios::binary), m_path(path), m_left(bytesOfFile(path)) {
        m_version = static_cast<unsigned char>(bytes(4)[3]);
    }

    [[noreturn]] void fail(const std::string& what) const { throw FileError(what, m_path, kCopyAgain); }

    std::string bytes(std::uint64_t count) {
        if (count > m_left) fail("the header of this NetCDF file ends too early");
        std::string text(count, '\0');
        m_in.read(text.data(), static_cast<std::streamsize>(count));
        if (!m_in) fail("the header of this NetCDF file ends too early");
        m_left -= count;
        return text;
    }
    void skip(std::uint64_t count) {
        if (count > m_left) fail("the header of this NetCDF file ends too early");
        m_in.seekg(static_cast<std::streamoff>(count), std::ios::cur);
        m_left -= count;
    }
    std::uint64_t number(std::uint64_t width) {
        std::uint64_t value = 0;
        for (const char byte : bytes(width)) value = value << 8 | static_cast<unsigned char>(byte);
        return value;
    }
    /// How many there are of something; what they take at least is in the file.
    std::uint64_t count() {
        const std::uint64_t value = size();
        if (value > m_left) fail("the header of this NetCDF file claims more than there is");
        return value;
    }
    std::uint64_t size() { return number(m_version == 5 ? 8 : 4); }
    std::uint64_t offset() { return number(m_version == 1 ? 4 : 8); }
    std::string name() {
        const std::uint64_t length = count();
        std::string text = bytes(length);
        skip((4 - length % 4) % 4);
        return text;
    }
    /// Entries of a list; `tag` says of what.
    std::uint64_t list(std::uint64_t tag) {
        const std::uint64_t found = number(4), entries = count();
        if (found != tag && (found != 0 || entries != 0)) fail("the header of this NetCDF file makes no sense");
        return entries;
    }
    NcType type() {
        const std::uint64_t value = number(4);
        if (value < 1 || value > 11) fail("the header of this NetCDF file names a type that there is not");
        return static_cast<NcType>(value);
    }
    /// The number of records; empty: as many as fit.
    std::optional<std::uint64_t> records() {
        const std::uint64_t value = size();
        const bool isOpen = m_version == 5 ? ~value == 0 : value == 0xffffffff;
        return isOpen ? std::nullopt : std::optional(value);
    }

private:
    std::ifstream m_in;
    const std::string m_path;
    std::uint64_t m_left;
    int m_version = 1;
};

ArrayAttribute attributeIn(Header& header) {
    ArrayAttribute attribute;
    const NcType type = header.type();
    const std::uint64_t width = bytesPer(type), count = header.count(), bytes = count * width;
    const std::uint64_t padded = (bytes + 3) / 4 * 4;
    attribute.areFloats = type == NcType::Float || type == NcType::Double;
    if (bytes > kMostAttribute) {
        header.skip(padded);
        return attribute;
    }
    std::string values = header.bytes(padded);
    values.resize(bytes);
    if (type == NcType::Char) {
        attribute.text = values.substr(0, values.find('\0'));
        return attribute;
    }
    const std::span<std::byte> raw = std::as_writable_bytes(std::span(values));
    toNative(raw, width);
    withType(valueTypeOf(type).value(), [&](auto value) {
        for (std::size_t at = 0; at < bytes; at += sizeof value) {
            std::memcpy(&value, raw.data() + at, sizeof value);
            attribute.numbers.push_back(static_cast<double>(value));
        }
    });
    return attribute;
}

using Attributes = std::map<std::string, ArrayAttribute>;

Attributes attributesIn(Header& header) {
    Attributes attributes;
    for (std::uint64_t left = header.list(0x0c); left > 0; --left) {
        const std::string name = header.name();
        attributes[name] = attributeIn(header);
    }
    return attributes;
}

/// Where the values of a variable are.
struct Place {
    Attributes attributes;
    std::vector<std::string> axes; ///< names of its dimensions
    NcType type = NcType::Byte;
    std::uint64_t begin = 0;
    bool hasRecords = false;       ///< its first axis is that of the records
    std::uint64_t recordBytes = 0; ///< of one record, or all of it, without what fills it up
};

class NetCdfFile final : public ArrayFile {
public:
    explicit NetCdfFile(const std::string& path) : m_path(path), m_bytes(bytesOfFile(path)) {
        Header header(path);
        const std::optional<std::uint64_t> records = header.records();
        std::vector<std::pair<std::string, std::uint64_t>> dimensions;
        for (std::uint64_t left = header.list(0x0a); left > 0; --left) {
            const std::string name = header.name();
            dimensions.emplace_back(name, header.size());
        }
        attributesIn(header); // of the whole file
        for (std::uint64_t left = header.list(0x0b); left > 0; --left) readVariable(header, dimensions);
        countRecords(records, header);
    }

    bool isNetCdf() const override { return true; }
    const std::vector<ArrayVariable>& variables() const override { return m_variables; }
    std::vector<std::string> files() const override { return {m_path}; }

    std::optional<ArrayAttribute> attribute(const ArrayVariable& variable, const std::string& name) const override {
        const Attributes& all = placeOf(variable).attributes;
        const auto found = all.find(name);
        return found == all.end() ? std::nullopt : std::optional(found->second);
    }

    std::vector<ArrayDimension> dimensions(const ArrayVariable& variable) const override {
        std::vector<ArrayDimension> all;
        for (const std::string& name : placeOf(variable).axes) {
            const ArrayVariable* coordinates = find("/" + name);
            const bool isLine = coordinates != nullptr && coordinates->dims.size() == 1;
            all.push_back({name, isLine ? "/" + name : ""});
        }
        return all;
    }

    std::vector<std::string> check(const ArrayVariable& variable) const override {
        const Place& place = placeOf(variable);
        const std::uint64_t after = place.hasRecords ? static_cast<std::uint64_t>(variable.dims[0]) - 1 : 0;
        const std::uint64_t room = m_bytes > place.begin ? m_bytes - place.begin : 0;
        const bool fits =
            place.recordBytes <= room && (after == 0 || m_recordBytes <= (room - place.recordBytes) / after);
        if (!fits)
            throw FileError("the values of " + inQuotes(variable.name) + " do not end within the file", m_path,
                            kCopyAgain);
        return {};
    }

    std::vector<std::int64_t> blockSize(const ArrayVariable& variable) const override {
        return std::vector<std::int64_t>(variable.dims.size(), 1);
    }

    std::optional<PlainValues> plainValues(const ArrayVariable& variable, const ArrayBox& box) const override {
        const Place& place = placeOf(variable);
        const bool areTogether = !place.hasRecords || box.size[0] == 1 || m_recordBytes == place.recordBytes;
        if (!areTogether || !isRun(variable, box)) return {};
        return PlainValues{offsetOf(variable, place, box.first), true};
    }

    void read(const ArrayVariable& variable, const ArrayBox& box, std::span<std::byte> to) const override {
        check(variable);
        const Place& place = placeOf(variable);
        const std::uint64_t width = bytesPer(place.type);
        std::ifstream in(m_path, std::ios::binary);
        // Axes from `whole` on are read in one go.
        std::size_t whole = variable.dims.size();
        std::uint64_t run = width;
        while (whole > (place.hasRecords ? 1u : 0u)) {
            --whole;
            run *= static_cast<std::uint64_t>(box.size[whole]);
            if (box.size[whole] != variable.dims[whole]) break;
        }
        std::vector<std::int64_t> index = box.first;
        for (std::uint64_t done = 0; done < to.size(); done += run) {
            in.seekg(static_cast<std::streamoff>(offsetOf(variable, place, index)));
            in.read(reinterpret_cast<char*>(to.data() + done), static_cast<std::streamsize>(run));
            if (!in) throw FileError("the file has become shorter while it was read", m_path, "open it again");
            for (std::size_t a = whole; a-- > 0;) {
                if (++index[a] < box.first[a] + box.size[a]) break;
                index[a] = box.first[a];
            }
        }
        toNative(to, width);
    }

private:
    const Place& placeOf(const ArrayVariable& variable) const { return m_places.at(variable.name); }

    void readVariable(Header& header, const std::vector<std::pair<std::string, std::uint64_t>>& dimensions) {
        ArrayVariable variable;
        variable.name = "/" + header.name();
        Place place;
        for (std::uint64_t left = header.count(); left > 0; --left) {
            const std::uint64_t id = header.size();
            if (id >= dimensions.size()) header.fail("the header of this NetCDF file makes no sense");
            const auto& [name, size] = dimensions[id];
            if (size > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
                header.fail("the header of this NetCDF file makes no sense");
            if (size == 0 && place.axes.empty()) place.hasRecords = true;
            place.axes.push_back(name);
            variable.dims.push_back(static_cast<std::int64_t>(size));
        }
        place.attributes = attributesIn(header);
        place.type = header.type();
        header.size(); // what it takes, which is known better
        place.begin = header.offset();
        variable.type = valueTypeOf(place.type);
        variable.typeName = variable.type ? nameOf(*variable.type) : "text";
        ArrayVariable record = variable;
        if (place.hasRecords) record.dims[0] = 1;
        place.recordBytes = valuesIn(record) * bytesPer(place.type);
        if (place.recordBytes == 0 && std::ranges::find(record.dims, 0) == record.dims.end())
            header.fail("the header of this NetCDF file claims more than there is"); // too many to count
        m_variables.push_back(variable);
        m_places[variable.name] = std::move(place);
    }

    /// Records follow each other behind all else, each with its part of all variables that have any.
    void countRecords(const std::optional<std::uint64_t>& claimed, const Header& header) {
        std::uint64_t sum = 0, single = 0, first = m_bytes;
        int count = 0;
        for (const auto& [name, place] : m_places) {
            if (!place.hasRecords) continue;
            ++count;
            single = place.recordBytes;
            sum += (std::min(place.recordBytes, m_bytes) + 3) / 4 * 4;
            first = std::min(first, place.begin);
        }
        m_recordBytes = count == 1 ? single : sum; // one alone is not filled up
        const std::uint64_t fitting = m_recordBytes == 0 ? 0 : (m_bytes - std::min(first, m_bytes)) / m_recordBytes;
        const std::uint64_t records = claimed.value_or(fitting);
        if (records > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
            header.fail("the header of this NetCDF file makes no sense");
        for (ArrayVariable& variable : m_variables)
            if (placeOf(variable).hasRecords) variable.dims[0] = static_cast<std::int64_t>(records);
    }

    std::uint64_t offsetOf(const ArrayVariable& variable, const Place& place,
                           const std::vector<std::int64_t>& index) const {
        std::uint64_t at = 0;
        for (std::size_t a = place.hasRecords ? 1 : 0; a < index.size(); ++a)
            at = at * static_cast<std::uint64_t>(variable.dims[a]) + static_cast<std::uint64_t>(index[a]);
        const std::uint64_t records = place.hasRecords ? static_cast<std::uint64_t>(index[0]) * m_recordBytes : 0;
        return place.begin + records + at * bytesPer(place.type);
    }

    const std::string m_path;
    const std::uint64_t m_bytes;
    std::uint64_t m_recordBytes = 0; ///< from one record to the next
    std::vector<ArrayVariable> m_variables;
    std::map<std::string, Place> m_places;
};

} // namespace

std::unique_ptr<ArrayFile> openNetCdf(const std::string& path, const BeforeFile& before) {
    before(bytesOfFile(path));
    return std::make_unique<NetCdfFile>(path);
}

} // namespace pellucid
