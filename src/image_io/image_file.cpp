#include "image_io/image_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/atomic_file.h"
#include "base/error.h"

namespace pellucid {

namespace {

std::string suffixOf(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    return suffix;
}

OIIO::TypeDesc sampleFormat(const std::string& suffix) {
    if (suffix == ".exr") return OIIO::TypeDesc::HALF;
    if (suffix == ".tif" || suffix == ".tiff") return OIIO::TypeDesc::UINT16;
    return OIIO::TypeDesc::UINT8;
}

/// The bytes of a file of these floats. In memory, since the libraries behind OpenImageIO overlook a full disk or end
/// the process.
std::vector<unsigned char> encoded(OIIO::ImageSpec spec, const float* values, std::size_t channels,
                                   const std::string& suffix, const std::string& path) {
    const auto out = OIIO::ImageOutput::create("image" + suffix);
    if (!out || !out->supports("ioproxy"))
        throw FileError("no writer for this kind of image", path, "choose another suffix");
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    void* proxy = &memory;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto stride = static_cast<OIIO::stride_t>(channels * sizeof(float));
    const bool good =
        out->open("image" + suffix, spec) && out->write_image(OIIO::TypeDesc::FLOAT, values, stride) && out->close();
    const std::string error = out->geterror(); // some come without a failure
    if (!good || !error.empty())
        throw FileError("cannot encode the image (" + error + ")", path, "choose another suffix");
    return bytes;
}

std::vector<unsigned char> encoded(const Image& image, const std::string& suffix, const std::string& path) {
    const int channels = suffix == ".jpg" || suffix == ".jpeg" ? 3 : 4;
    OIIO::ImageSpec spec(image.width, image.height, channels, sampleFormat(suffix));
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1); // Image holds straight colours
    // OpenImageIO 2.4 spoils a TIFF in memory by a directory for Exif tags, which would only say sRGB.
    spec.attribute("tiff:write_exif", 0);
    return encoded(std::move(spec), image.rgba.data(), 4, suffix, path);
}

} // namespace

void checkImageSuffix(const std::string& path) {
    const std::string suffix = suffixOf(path);
    for (const char* known : {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg"})
        if (suffix == known) return;
    throw UsageError("images are written as .png, .exr, .tif or .jpg", path, "give one of these suffixes");
}

void writeImage(const Image& image, const std::string& path) {
    checkImageSuffix(path);
    writeBytesAtomically(path, encoded(image, suffixOf(path), path));
}

std::vector<unsigned char> pngOf(const Image& image) { return encoded(image, ".png", "a picture in memory"); }

void checkPlaneSuffix(const std::string& path) {
    const std::string suffix = suffixOf(path);
    if (suffix != ".png" && suffix != ".exr")
        throw UsageError("a map is written as .exr or .png", path, "give one of these suffixes");
}

void writePlane(const Plane& plane, const std::string& path) {
    checkPlaneSuffix(path);
    const std::string suffix = suffixOf(path);
    OIIO::ImageSpec spec(plane.width, plane.height, 1,
                         suffix == ".exr" ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:ColorSpace", "Linear"); // numbers, not colours
    writeBytesAtomically(path, encoded(std::move(spec), plane.values.data(), 1, suffix, path));
}

Image readImage(const std::string& path) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(path, &config);
    if (!in) throw FileError("cannot read the image (" + OIIO::geterror() + ")", path, "check the file");
    const OIIO::ImageSpec& spec = in->spec();
    const int channels = spec.nchannels;
    const auto pixels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    std::vector<float> raw(pixels * static_cast<std::size_t>(channels));
    if (!in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, raw.data()))
        throw FileError("cannot read the image (" + in->geterror() + ")", path, "check the file");
    Image image(spec.width, spec.height);
    for (std::size_t p = 0; p < pixels; ++p) {
        const float* from = &raw[p * static_cast<std::size_t>(channels)];
        for (int c = 0; c < 3; ++c) image.rgba[4 * p + static_cast<std::size_t>(c)] = from[channels >= 3 ? c : 0];
        image.rgba[4 * p + 3] = channels == 4 || channels == 2 ? from[channels - 1] : 1.0f;
    }
    return image;
}

} // namespace pellucid
