#include "image_io/png_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <istream>
#include <optional>
#include <string_view>

#include <zlib.h>

#include "base/error.h"
#include "image_io/png_chunks.h"

namespace pellucid {

namespace {

constexpr std::uint32_t kLongestChunk = 0x7fffffff; ///< of the format
constexpr std::size_t kLongestKeyword = 79;         ///< likewise

/// The chunks of a file, one after the other.
class Chunks {
public:
    Chunks(std::istream& in, const std::string& path) : m_in(in), m_path(path) {
        std::array<char, png::kSignature.size()> begin{};
        m_in.read(begin.data(), begin.size());
        if (!m_in || std::string_view(begin.data(), begin.size()) != png::kSignature) fail("this is no PNG file");
    }

    /// False: that was the last one.
    bool next() {
        std::array<char, 8> head{};
        m_in.read(head.data(), head.size());
        if (!m_in) fail("the PNG file ends too early");
        m_size = png::numberIn(png::bytesOf({head.data(), head.size()}));
        m_name.assign(head.data() + 4, 4);
        if (m_size > kLongestChunk) fail("a part of the PNG file is longer than the format allows");
        return m_name != "IEND";
    }
    const std::string& name() const { return m_name; }

    /// The data of the chunk, whose checksum is right.
    std::string data(std::size_t most) {
        if (m_size > most) fail("the texts in the PNG file are too long");
        std::string bytes;
        // Piece by piece: what the chunk claims need not be there.
        while (bytes.size() < m_size) {
            const std::size_t had = bytes.size(), piece = std::min<std::size_t>(m_size - had, std::size_t{1} << 16);
            bytes.resize(had + piece);
            m_in.read(&bytes[had], static_cast<std::streamsize>(piece));
            if (!m_in) fail("the PNG file ends too early");
        }
        std::array<char, 4> sum{};
        m_in.read(sum.data(), sum.size());
        if (!m_in) fail("the PNG file ends too early");
        const std::uint32_t stored = png::numberIn(png::bytesOf({sum.data(), sum.size()}));
        if (png::checksumOf(m_name, png::bytesOf(bytes)) != stored) fail("a text in the PNG file is damaged");
        return bytes;
    }
    void skip() {
        m_in.seekg(static_cast<std::streamoff>(m_size) + 4, std::ios::cur);
        if (!m_in) fail("the PNG file ends too early");
    }

    [[noreturn]] void fail(const std::string& what) const { throw FileError(what, m_path, "check the file"); }

private:
    std::istream& m_in;
    const std::string& m_path;
    std::string m_name;
    std::uint32_t m_size = 0;
};

std::string fromLatin1(std::string_view bytes) {
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) {
            text += c;
        } else {
            text += static_cast<char>(0xc0 | byte >> 6);
            text += static_cast<char>(0x80 | (byte & 0x3f));
        }
    }
    return text;
}

/// Empty where the bytes are not what zlib has packed, or more than `most` come out.
std::optional<std::string> unpacked(std::string_view bytes, std::size_t most) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return {};
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data())); // zlib only reads there
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::string text;
    std::array<char, 1 << 14> piece{};
    int status = Z_OK;
    while (status == Z_OK && text.size() <= most) {
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = static_cast<uInt>(piece.size());
        status = inflate(&stream, Z_NO_FLUSH);
        text.append(piece.data(), piece.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END || text.size() > most) return {};
    return text;
}

/// What stands before the next 0, which is taken away with it; empty where there is none.
std::optional<std::string_view> takeString(std::string_view& data) {
    const std::size_t end = data.find('\0');
    if (end == std::string_view::npos) return {};
    const std::string_view text = data.substr(0, end);
    data.remove_prefix(end + 1);
    return text;
}

/// Of a chunk of this name; empty where it does not follow the format. At most `most` bytes.
std::optional<PngText> textIn(const std::string& name, std::string_view data, std::size_t most) {
    const auto keyword = takeString(data);
    if (!keyword || keyword->empty() || keyword->size() > kLongestKeyword) return {};
    PngText text{fromLatin1(*keyword), {}};
    if (name == "tEXt") {
        text.text = fromLatin1(data);
        return text;
    }
    bool isPacked = true;
    if (name == "iTXt") {
        if (data.empty()) return {};
        isPacked = data.front() != 0;
        data.remove_prefix(1);
    }
    if (data.empty() || (isPacked && data.front() != 0)) return {}; // 0: by zlib, the only way
    data.remove_prefix(1);
    if (name == "iTXt" && (!takeString(data) || !takeString(data))) return {}; // language, translated keyword
    std::optional<std::string> value = isPacked ? unpacked(data, most) : std::string(data);
    if (!value) return {};
    text.text = name == "zTXt" ? fromLatin1(*value) : std::move(*value);
    return text;
}

} // namespace

std::vector<PngText> readPngTexts(std::istream& in, const std::string& path) {
    Chunks chunks(in, path);
    std::vector<PngText> texts;
    std::size_t left = kMostPngText;
    while (chunks.next()) {
        if (chunks.name() != "tEXt" && chunks.name() != "zTXt" && chunks.name() != "iTXt") {
            chunks.skip();
            continue;
        }
        const std::string data = chunks.data(left);
        std::optional<PngText> text = textIn(chunks.name(), data, left);
        if (!text) chunks.fail("a text in the PNG file is damaged, or too long");
        // The empty ones count, too.
        left -= std::min(left, std::max(data.size(), text->keyword.size() + text->text.size()));
        texts.push_back(std::move(*text));
    }
    return texts;
}

std::vector<PngText> readPngTexts(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw FileError("the file cannot be opened", path, "check its name and permissions");
    return readPngTexts(in, path);
}

bool isPngFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::array<char, png::kSignature.size()> begin{};
    in.read(begin.data(), begin.size());
    return in && std::string_view(begin.data(), begin.size()) == png::kSignature;
}

} // namespace pellucid
