#include "image_io/image_file.h"

#include <algorithm>
#include <filesystem>

#include <dlfcn.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "image_io/image_codecs.h"
#include "image_io/png_bytes.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::string suffixOf(const std::string& path) { return lowerCase(fs::path(path).extension().string()); }

SampleKind samplesOf(const std::string& suffix) {
    if (suffix == ".exr") return SampleKind::Halves;
    if (suffix == ".tif" || suffix == ".tiff") return SampleKind::Shorts;
    return SampleKind::Bytes;
}

/// Beside the program, as built, or where it is installed.
fs::path pathOfCodecs() {
    std::error_code ec;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
    const fs::path beside = folder / PELLUCID_IMAGE_CODECS;
    return fs::exists(beside, ec) ? beside : folder / PELLUCID_LIBRARIES_FROM_PROGRAMS / PELLUCID_IMAGE_CODECS;
}

/// Loads them once. Throws FileError.
const ImageCodecs& codecs() {
    static const ImageCodecs& loaded = []() -> const ImageCodecs& {
        const std::string path = pathOfCodecs().string();
        void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const symbol = library == nullptr ? nullptr : ::dlsym(library, kImageCodecsSymbol);
        if (symbol == nullptr) {
            const char* const why = ::dlerror();
            std::error_code ec;
            if (!fs::exists(path, ec))
                throw FileError("the part of the program that reads pictures, and writes others than PNG, is not "
                                "installed",
                                path, "install the package pellucid-images, or write a .png file");
            throw FileError(std::string("the part of the program that reads and writes pictures cannot be loaded (") +
                                (why == nullptr ? "no reason given" : why) + ")",
                            path, "install the program again");
        }
        return *reinterpret_cast<const ImageCodecs* (*)()>(symbol)();
    }();
    return loaded;
}

/// The bytes of a file of that suffix. Throws FileError.
std::vector<unsigned char> encoded(const ImageToEncode& image, const std::string& suffix, const std::string& path) {
    std::vector<unsigned char> bytes;
    const std::string error = codecs().encode(image, suffix, bytes);
    if (!error.empty()) throw FileError("cannot encode the image (" + error + ")", path, "choose another suffix");
    return bytes;
}

std::vector<unsigned char> encoded(const Image& image, const std::string& suffix, const std::string& path) {
    const int channels = suffix == ".jpg" || suffix == ".jpeg" ? 3 : 4;
    if (suffix == ".png") return pngBytes(image);
    return encoded({image.width, image.height, channels, samplesOf(suffix), ValueKind::Colors, image.rgba.data(), 4},
                   suffix, path);
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

std::vector<unsigned char> pngOf(const Image& image) { return pngBytes(image); }

void checkPlaneSuffix(const std::string& path) {
    const std::string suffix = suffixOf(path);
    if (suffix != ".png" && suffix != ".exr")
        throw UsageError("a map is written as .exr or .png", path, "give one of these suffixes");
}

void writePlane(const Plane& plane, const std::string& path) {
    checkPlaneSuffix(path);
    const std::string suffix = suffixOf(path);
    const ImageToEncode image{plane.width,        plane.height,        1, SampleKind::Floats,
                              ValueKind::Numbers, plane.values.data(), 1};
    writeBytesAtomically(path, suffix == ".png" ? pngBytes(plane) : encoded(image, suffix, path));
}

Image readImage(const std::string& path) {
    DecodedImage decoded;
    const std::string error = codecs().decode(path, decoded);
    if (!error.empty()) throw FileError("cannot read the image (" + error + ")", path, "check the file");
    const auto channels = static_cast<std::size_t>(decoded.channels);
    Image image(decoded.width, decoded.height);
    for (std::size_t p = 0; p < image.rgba.size() / 4; ++p) {
        const float* from = &decoded.values[p * channels];
        for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * p + c] = from[channels >= 3 ? c : 0];
        image.rgba[4 * p + 3] = channels == 4 || channels == 2 ? from[channels - 1] : 1.0f;
    }
    return image;
}

} // namespace pellucid
