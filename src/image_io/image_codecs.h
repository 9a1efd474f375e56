// What encodes and decodes pictures: a library of its own, loaded when the first picture is read, or one that is no PNG
// file written. The libraries behind OpenImageIO, some 200, take a quarter of a second to load, which no other command
// should wait for.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pellucid {

enum class SampleKind { Bytes, Shorts, Floats }; ///< in the file: integers of 8 and 16 bits, floats of 32
enum class ValueKind { Colors, Numbers };        ///< sRGB with straight alpha; whatever else, such as linear light

/// Rows from the top, `valuesPerPixel` floats each, of which the file gets the first `channels`.
struct ImageToEncode {
    int width, height, channels;
    SampleKind samples;
    ValueKind kind;
    const float* values;
    std::size_t valuesPerPixel;
    std::vector<std::string> channelNames = {};                  ///< empty: the usual ones
    std::vector<std::pair<std::string, std::string>> texts = {}; ///< what the file says, by OpenImageIO's names
    std::vector<unsigned char> iccProfile = {};                  ///< empty: none
};

/// Rows from the top, `channels` floats per pixel.
struct DecodedImage {
    int width = 0, height = 0, channels = 0;
    int alpha = -1; ///< the channel that has it; -1: none
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
