#include "image_io/image_file.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <thread>

#include <dlfcn.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/text.h"
#include "image_io/image_codecs.h"
#include "image_io/png_bytes.h"
#include "image_io/srgb_profile.h"
#include "tf/lch.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

std::string suffixOf(const std::string& path) { return lowerCase(fs::path(path).extension().string()); }

SampleKind samplesOf(const std::string& suffix) {
    if (suffix == ".exr") return SampleKind::Floats;
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

/// Libraries under OpenImageIO start threads while they are loaded, as many as there are processors, and end the
/// program where they get none.
void requireThreads() {
    const unsigned many = std::max(8u, std::thread::hardware_concurrency());
    std::atomic<bool> isWaiting = true;
    const auto release = [&] {
        isWaiting = false;
        isWaiting.notify_all();
    };
    std::vector<std::jthread> threads;
    try {
        for (unsigned i = 0; i < many; ++i) threads.emplace_back([&] { isWaiting.wait(true); });
    } catch (...) {
        release();
        throw;
    }
    release();
}

/// Loads them once. Throws FileError, std::system_error.
const ImageCodecs& codecs() {
    static const ImageCodecs& loaded = []() -> const ImageCodecs& {
        requireThreads();
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

std::vector<PngText> pngTexts(const PictureText& text) {
    std::vector<PngText> texts;
    for (const auto& [keyword, value] : {std::pair(kSoftwareKeyword, &text.software),
                                         {kDescriptionKeyword, &text.description},
                                         {kCommandKeyword, &text.command},
                                         {kSessionKeyword, &text.session}})
        if (!value->empty()) texts.push_back({keyword, *value});
    return texts;
}

/// By the names that OpenImageIO has for them.
std::vector<std::pair<std::string, std::string>> foreignTexts(const PictureText& text, const std::string& suffix) {
    std::vector<std::pair<std::string, std::string>> texts;
    for (const PngText& one : pngTexts(text)) {
        const bool isOwn = one.keyword == kCommandKeyword || one.keyword == kSessionKeyword;
        if (isOwn && suffix != ".exr") continue; // there is no tag for it
        texts.emplace_back(one.keyword == kDescriptionKeyword ? "ImageDescription" : one.keyword, one.text);
    }
    return texts;
}

/// Straight sRGB to linear light, premultiplied.
std::vector<float> linearLight(const Image& image) {
    std::vector<float> light = image.rgba;
    for (std::size_t i = 0; i < light.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            light[i + c] = static_cast<float>(linearFromSrgb(light[i + c])) * light[i + 3];
    return light;
}

/// And back.
void becomeSrgb(Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const float alpha = image.rgba[i + 3];
        for (std::size_t c = 0; c < 3; ++c) {
            float& value = image.rgba[i + c];
            value = static_cast<float>(srgbFromLinear(alpha > 0 ? value / alpha : value));
        }
    }
}

std::vector<unsigned char> encoded(const Image& image, const std::string& suffix, const std::string& path,
                                   const PictureText& text) {
    if (suffix == ".png") return pngBytes(image, pngTexts(text));
    const int channels = suffix == ".jpg" || suffix == ".jpeg" ? 3 : 4;
    ImageToEncode encoding{image.width,       image.height,      channels, samplesOf(suffix),
                           ValueKind::Colors, image.rgba.data(), 4};
    encoding.texts = foreignTexts(text, suffix);
    if (encoding.samples == SampleKind::Shorts) encoding.iccProfile = srgbIccProfile();
    std::vector<float> light;
    if (suffix == ".exr") {
        light = linearLight(image);
        encoding.kind = ValueKind::Numbers;
        encoding.values = light.data();
    }
    return encoded(encoding, suffix, path);
}

} // namespace

void checkImageSuffix(const std::string& path) {
    const std::string suffix = suffixOf(path);
    for (const char* known : {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg"})
        if (suffix == known) return;
    throw UsageError("images are written as .png, .exr, .tif or .jpg", path, "give one of these suffixes");
}

void writeImage(const Image& image, const std::string& path, const PictureText& text) {
    checkImageSuffix(path);
    writeBytesAtomically(path, encoded(image, suffixOf(path), path, text));
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

std::vector<unsigned char> exrOf(int width, int height, const std::vector<std::string>& channels,
                                 const std::vector<float>& values,
                                 const std::vector<std::pair<std::string, std::string>>& texts,
                                 const std::string& path) {
    ImageToEncode image{
        width,         height,         static_cast<int>(channels.size()), SampleKind::Floats, ValueKind::Numbers,
        values.data(), channels.size()};
    image.channelNames = channels;
    image.texts = texts;
    return encoded(image, ".exr", path);
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
        image.rgba[4 * p + 3] = decoded.alpha >= 0 ? from[decoded.alpha] : 1.0f;
    }
    if (channels >= 3 && suffixOf(path) == ".exr") becomeSrgb(image);
    return image;
}

} // namespace pellucid
