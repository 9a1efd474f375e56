#include "image_io/animated_png.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image_io/png_chunks.h"

namespace pellucid {

namespace {

using png::addNumber, png::Bytes, png::kFrame, png::numberIn, png::Span;

/// A piece of a file, "IDAT" and its kind.
struct Piece {
    std::string_view name;
    Span data, whole;
};

/// Empty where this is no PNG file or one that is damaged.
std::optional<std::vector<Piece>> piecesOf(Span file) {
    const Span signature = png::bytesOf(png::kSignature);
    if (file.size() < signature.size() || !std::ranges::equal(signature, file.first(signature.size()))) return {};
    std::vector<Piece> pieces;
    for (std::size_t at = signature.size(); at < file.size();) {
        if (file.size() - at < kFrame) return {};
        const std::size_t length = numberIn(file.subspan(at));
        if (file.size() - at - kFrame < length) return {};
        const std::string_view name(reinterpret_cast<const char*>(&file[at + 4]), 4);
        const Span data = file.subspan(at + 8, length);
        if (png::checksumOf(name, data) != numberIn(file.subspan(at + 8 + length))) return {};
        pieces.push_back({name, data, file.subspan(at, kFrame + length)});
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
    explicit Writer(OutputFile& out) : m_out(out) { write(png::bytesOf(png::kSignature)); }
    void add(const Piece& piece) { write(piece.whole); }
    void add(std::string_view name, const Bytes& data) {
        Bytes chunk;
        png::addChunk(chunk, name, data);
        write(chunk);
    }

private:
    void write(Span bytes) { m_out.write(bytes.data(), bytes.size()); }

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
    return pieces && numberIn(pieces->front().data) == static_cast<std::uint32_t>(width) &&
           numberIn(pieces->front().data.subspan(4)) == static_cast<std::uint32_t>(height);
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
