// What encodes and decodes pictures: a library of its own, loaded when the first picture is read, or one that is no PNG
// file written. The libraries behind OpenImageIO, some 200, take a quarter of a second to load, which no other command
// should wait for.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid {

enum class SampleKind {
    Bytes,
    Shorts,
    Halves,
    Floats
};                                        ///< in the file: integers of 8 and 16 bits, floats of 16 and 32
enum class ValueKind { Colors, Numbers }; ///< sRGB with straight alpha; whatever else

/// Rows from the top, `valuesPerPixel` floats each, of which the file gets the first `channels`.
struct ImageToEncode {
    int width, height, channels;
    SampleKind samples;
    ValueKind kind;
    const float* values;
    std::size_t valuesPerPixel;
};

/// Rows from the top, `channels` floats per pixel.
struct DecodedImage {
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;
};

/// The functions return what went wrong; empty: nothing.
struct ImageCodecs {
    /// The bytes of a file of that suffix (".png"). In memory, since the libraries overlook a full disk or end the
    /// process.
    std::string (*encode)(const ImageToEncode& image, const std::string& suffix, std::vector<unsigned char>& bytes);
    std::string (*decode)(const std::string& path, DecodedImage& image);
};

/// The name under which the library has them: a function without arguments that returns `const ImageCodecs*`.
inline constexpr const char* kImageCodecsSymbol = "pellucidImageCodecs";

} // namespace pellucid
