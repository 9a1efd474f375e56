#include "image_io/animated_png.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include <zlib.h>

#include "base/atomic_file.h"
#include "base/error.h"

namespace pellucid {

namespace {

using Bytes = std::vector<unsigned char>;
using Span = std::span<const unsigned char>;

constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kFrame = 12; ///< bytes of a piece around its data: length, name, checksum

std::uint32_t numberAt(Span bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
    return value;
}

/// Its lowest bytes, the highest of them first.
void addNumber(Bytes& bytes, std::uint32_t value, std::ptrdiff_t count = 4) {
    const std::array<unsigned char, 4> all{static_cast<unsigned char>(value >> 24),
                                           static_cast<unsigned char>(value >> 16),
                                           static_cast<unsigned char>(value >> 8), static_cast<unsigned char>(value)};
    bytes.insert(bytes.end(), all.end() - count, all.end());
}

/// A piece of a file, "IDAT" and its kind.
struct Piece {
    std::string_view name;
    Span data, whole;
};

/// Empty where this is no PNG file or one that is damaged.
std::optional<std::vector<Piece>> piecesOf(Span file) {
    if (file.size() < kSignature.size() || !std::equal(kSignature.begin(), kSignature.end(), file.begin())) return {};
    std::vector<Piece> pieces;
    for (std::size_t at = kSignature.size(); at < file.size();) {
        if (file.size() - at < kFrame) return {};
        const std::size_t length = numberAt(file, at);
        if (file.size() - at - kFrame < length) return {};
        const Span named = file.subspan(at + 4, 4 + length);
        if (crc32(0, named.data(), static_cast<uInt>(named.size())) != numberAt(file, at + 8 + length)) return {};
        pieces.push_back(
            {{reinterpret_cast<const char*>(named.data()), 4}, named.subspan(4), file.subspan(at, kFrame + length)});
        at += kFrame + length;
    }
    const bool isWhole = pieces.size() > 2 && pieces.front().name == "IHDR" && pieces.front().data.size() == 13 &&
                         pieces.back().name == "IEND";
    return isWhole ? std::optional(std::move(pieces)) : std::nullopt;
}

Bytes bytesOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class Writer {
public:
    explicit Writer(OutputFile& out) : m_out(out) { out.write(kSignature.data(), kSignature.size()); }
    void add(const Piece& piece) { m_out.write(piece.whole.data(), piece.whole.size()); }
    void add(std::string_view name, const Bytes& data) {
        Bytes length, named(name.begin(), name.end()), sum;
        addNumber(length, static_cast<std::uint32_t>(data.size()));
        named.insert(named.end(), data.begin(), data.end());
        addNumber(sum, static_cast<std::uint32_t>(crc32(0, named.data(), static_cast<uInt>(named.size()))));
        for (const Bytes* part : {&length, &named, &sum}) m_out.write(part->data(), part->size());
    }

private:
    OutputFile& m_out;
};

/// How long a picture stays, as the format has it: a fraction of two numbers of 16 bits, s.
struct Delay {
    std::uint32_t above, below;
};
Delay delayOf(double framesPerSecond) {
    const double whole = std::round(framesPerSecond);
    if (std::abs(framesPerSecond - whole) < 1e-9 && whole >= 1 && whole <= 65535)
        return {1, static_cast<std::uint32_t>(whole)};
    if (framesPerSecond >= 1)
        return {100, static_cast<std::uint32_t>(std::min(65535.0, std::round(100 * framesPerSecond)))};
    return {static_cast<std::uint32_t>(std::clamp(std::round(100 / framesPerSecond), 1.0, 65535.0)), 100};
}

/// Size, place, delay of a picture: it replaces all of the one before.
Bytes controlOf(std::uint32_t sequence, Span size, const Delay& delay) {
    Bytes control;
    addNumber(control, sequence);
    control.insert(control.end(), size.begin(), size.end());
    addNumber(control, 0);
    addNumber(control, 0);
    addNumber(control, delay.above, 2);
    addNumber(control, delay.below, 2);
    addNumber(control, 0, 2);
    return control;
}

[[noreturn]] void failOf(const std::string& picture) {
    throw FileError("this is no whole picture of the film", picture, "draw the film anew");
}

} // namespace

bool isWholePng(Span bytes, int width, int height) {
    const auto pieces = piecesOf(bytes);
    return pieces && numberAt(pieces->front().data, 0) == static_cast<std::uint32_t>(width) &&
           numberAt(pieces->front().data, 4) == static_cast<std::uint32_t>(height);
}

bool isWholePngFile(const std::string& path, int width, int height) { return isWholePng(bytesOf(path), width, height); }

void writeAnimatedPng(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                      const std::stop_token& stop) {
    if (pictures.empty()) return;
    const Delay delay = delayOf(framesPerSecond);
    writeAtomically(path, [&](OutputFile& file) {
        Writer out(file);
        Bytes head;
        std::uint32_t sequence = 0;
        for (const std::string& picture : pictures) {
            if (stop.stop_requested()) throw Cancelled{};
            const Bytes bytes = bytesOf(picture);
            const auto pieces = piecesOf(bytes);
            if (!pieces) failOf(picture);
            const Span header = pieces->front().data;
            const bool isFirst = head.empty();
            if (isFirst) {
                head.assign(header.begin(), header.end());
                out.add(pieces->front());
                for (const Piece& p : *pieces)
                    if (p.name == "sRGB") out.add(p);
                Bytes counts;
                addNumber(counts, static_cast<std::uint32_t>(pictures.size()));
                addNumber(counts, 0); // forever
                out.add("acTL", counts);
            } else if (!std::equal(header.begin(), header.end(), head.begin())) {
                failOf(picture);
            }
            out.add("fcTL", controlOf(sequence++, header.first(8), delay));
            for (const Piece& p : *pieces) {
                if (p.name != "IDAT") continue;
                if (isFirst) {
                    out.add(p);
                    continue;
                }
                Bytes data;
                addNumber(data, sequence++);
                data.insert(data.end(), p.data.begin(), p.data.end());
                out.add("fdAT", data);
            }
        }
        out.add("IEND", {});
    });
}

} // namespace pellucid
