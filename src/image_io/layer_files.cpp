#include "image_io/layer_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"
#include "base/text.h"
#include "base/utf8.h"
#include "image_io/image_file.h"
#include "image_io/png_bytes.h"
#include "tf/lch.h"

namespace pellucid {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr const char* kFormat = "pellucid-layers";
constexpr const char* kIndex = "layers.json";
constexpr std::size_t kLongestName = 64; ///< bytes

/// What neither channels, whose names points divide, nor files of any system may have.
bool isAllowed(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 ||
           (byte > 0x20 && std::string_view("./\\:*?\"'<>|,;=%$&`~#!").find(c) == std::string_view::npos);
}

std::string harmless(const std::string& name) {
    constexpr std::string_view kReplacement = "\xef\xbf\xbd"; // U+FFFD, what printable() puts for what it takes away
    std::string text = printable(name);
    for (std::size_t at; (at = text.find(kReplacement)) != std::string::npos;) text.replace(at, 3, "_");
    for (char& c : text)
        if (!isAllowed(c)) c = '_';
    if (text.starts_with('-')) text.front() = '_'; // else it looks like an option
    text = cutAtCharacter(std::move(text), kLongestName);
    return text.empty() ? "feature" : text;
}

/// What a picture's premultiplied component is multiplied by to become linear light, at this straight one.
float lightPerComponent(float straight) {
    constexpr float kNearBlack = 1e-4f; // the curve is straight there
    return straight > kNearBlack ? static_cast<float>(linearFromSrgb(straight)) / straight : 1 / 12.92f;
}

struct Channels {
    std::vector<std::string> names;
    std::vector<float> values; ///< pixel by pixel
};

Channels channelsOf(const PictureLayers& layers, const std::vector<std::string>& names) {
    Channels channels;
    const auto add = [&](const std::string& layer, std::string_view components) {
        for (const char c : components) channels.names.push_back(layer + c);
    };
    add("", "RGBA");
    std::vector<const Image*> parts;
    for (std::size_t f = 0; f < names.size(); ++f) {
        add("feature." + names[f] + ".", "RGBA");
        parts.push_back(&layers.features[f]);
    }
    add("rest.", "RGBA");
    parts.push_back(&layers.rest);
    add("depth.", "Z");
    add("normal.", "XYZ");
    const std::size_t pixels = layers.depth.values.size();
    channels.values.reserve(pixels * channels.names.size());
    for (std::size_t p = 0; p < pixels; ++p) {
        const float* const whole = &layers.picture.rgba[4 * p];
        std::array<float, 4> light{1, 1, 1, 1};
        for (std::size_t c = 0; c < 3; ++c) light[c] = lightPerComponent(whole[c]);
        for (std::size_t c = 0; c < 4; ++c) channels.values.push_back(whole[c] * light[c] * (c < 3 ? whole[3] : 1));
        for (const Image* part : parts)
            for (std::size_t c = 0; c < 4; ++c) channels.values.push_back(part->rgba[4 * p + c] * light[c]);
        channels.values.push_back(layers.depth.values[p]);
        for (std::size_t a = 0; a < 3; ++a) channels.values.push_back(layers.normals[3 * p + a]);
    }
    return channels;
}

std::vector<std::pair<std::string, std::string>> textsOf(const PictureText& text) {
    std::vector<std::pair<std::string, std::string>> texts;
    for (const auto& [name, value] : {std::pair(kSoftwareKeyword, &text.software),
                                      {"ImageDescription", &text.description},
                                      {kCommandKeyword, &text.command},
                                      {kSessionKeyword, &text.session}})
        if (!value->empty()) texts.emplace_back(name, *value);
    return texts;
}

Image straight(const Image& premultiplied) {
    Image image = premultiplied;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            image.rgba[i + c] = image.rgba[i + 3] > 0 ? image.rgba[i + c] / image.rgba[i + 3] : 0;
    return image;
}

Plane shareOf(const Image& layer) {
    Plane share(layer.width, layer.height);
    for (std::size_t p = 0; p < share.values.size(); ++p) share.values[p] = layer.rgba[4 * p + 3];
    return share;
}

/// The least and greatest depth; both 0 where there is none.
std::pair<double, double> rangeOf(const Plane& depth) {
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (const float d : depth.values)
        if (std::isfinite(d)) lo = std::min<double>(lo, d), hi = std::max<double>(hi, d);
    return lo <= hi ? std::pair(lo, hi) : std::pair(0.0, 0.0);
}

/// 0 where there is no depth, else 1 to 65535 of 65535 from `lo` to `hi`.
Plane depthInRange(const Plane& depth, double lo, double hi) {
    Plane scaled(depth.width, depth.height);
    for (std::size_t p = 0; p < depth.values.size(); ++p) {
        if (!std::isfinite(depth.values[p])) continue;
        const double part = hi > lo ? (static_cast<double>(depth.values[p]) - lo) / (hi - lo) : 0;
        scaled.values[p] = static_cast<float>((1 + 65534 * part) / 65535);
    }
    return scaled;
}

/// Components from −1 to 1 as 0 to 1; alpha 0 where there is none.
Image normalsAsColors(const PictureLayers& layers) {
    Image image(layers.depth.width, layers.depth.height);
    for (std::size_t p = 0; p < layers.depth.values.size(); ++p) {
        const float* const n = &layers.normals[3 * p];
        if (n[0] == 0 && n[1] == 0 && n[2] == 0) continue;
        for (std::size_t a = 0; a < 3; ++a) image.rgba[4 * p + a] = 0.5f + 0.5f * n[a];
        image.rgba[4 * p + 3] = 1;
    }
    return image;
}

/// A folder that writeLayers() has made, by its index.
bool isOfLayers(const std::string& folder) {
    try {
        const json index = readJson((fs::path(folder) / kIndex).string());
        return index.is_object() && index.value("format", json()) == kFormat;
    } catch (const Error&) {
        return false;
    }
}

std::string_view viewOf(const std::vector<unsigned char>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void writeFolder(const PictureLayers& layers, const std::vector<Feature>& features, const std::string& path,
                 const PictureText& text, const JobControl& job) {
    const std::vector<std::string> names = layerNames(features);
    std::vector<PngText> texts;
    for (const auto& [name, value] : textsOf(text))
        texts.push_back({name == "ImageDescription" ? kDescriptionKeyword : name, value});
    writeFolderAtomically(path, isOfLayers, [&](OutputFolder& folder) {
        const std::size_t steps = 2 * names.size() + 4;
        std::size_t done = 0;
        const auto put = [&](const std::string& file, const std::vector<unsigned char>& bytes) {
            folder.write(file, viewOf(bytes));
            job.throwIfStopped();
            job.report(static_cast<double>(++done) / static_cast<double>(steps));
            return file;
        };
        json index{{"format", kFormat}, {"version", 1}, {"size", {layers.picture.width, layers.picture.height}}};
        index["picture"] = put("picture.png", pngBytes(layers.picture, texts));
        index["features"] = json::array();
        for (std::size_t f = 0; f < names.size(); ++f)
            index["features"].push_back(
                {{"name", printable(features[f].name)},
                 {"picture", put("feature_" + names[f] + ".png", deepPngBytes(straight(layers.features[f])))},
                 {"mask", put("mask_" + names[f] + ".png", pngBytes(shareOf(layers.features[f])))}});
        index["rest"] = put("rest.png", deepPngBytes(straight(layers.rest)));
        const auto [lo, hi] = rangeOf(layers.depth);
        index["depth"] = {{"file", put("depth.png", pngBytes(depthInRange(layers.depth, lo, hi)))},
                          {"range", {lo, hi}}};
        index["normal"] = put("normal.png", deepPngBytes(normalsAsColors(layers), false));
        folder.write(kIndex, index.dump(1) + "\n");
    });
}

void writeFile(const PictureLayers& layers, const std::vector<Feature>& features, const std::string& path,
               const PictureText& text, const JobControl& job) {
    const std::vector<std::string> names = layerNames(features);
    json list = json::array();
    for (std::size_t f = 0; f < names.size(); ++f)
        list.push_back({{"name", printable(features[f].name)}, {"layer", "feature." + names[f]}});
    std::vector<std::pair<std::string, std::string>> texts = textsOf(text);
    texts.emplace_back("pellucid:layers", list.dump());
    const Channels channels = channelsOf(layers, names);
    job.throwIfStopped();
    job.report(0.3);
    const std::vector<unsigned char> bytes =
        exrOf(layers.picture.width, layers.picture.height, channels.names, channels.values, texts, path);
    job.throwIfStopped();
    job.report(0.9);
    writeBytesAtomically(path, bytes);
}

} // namespace

std::vector<std::string> layerNames(const std::vector<Feature>& features) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const Feature& feature : features) {
        const std::string base = harmless(feature.name);
        std::string name = base;
        for (int n = 2; !taken.insert(lowerCase(name)).second; ++n) {
            const std::string ending = "_" + std::to_string(n);
            name = cutAtCharacter(base, kLongestName - ending.size()) + ending;
        }
        names.push_back(name);
    }
    return names;
}

bool isLayersFile(const std::string& path) { return lowerCase(fs::path(path).extension().string()) == ".exr"; }

void checkLayersPath(const std::string& path) {
    const std::string suffix = lowerCase(fs::path(path).extension().string());
    for (const char* other : {".png", ".tif", ".tiff", ".jpg", ".jpeg"})
        if (suffix == other)
            throw UsageError("layers are written as one .exr file or as a folder of pictures", path,
                             "name a file *.exr, or a folder");
}

void writeLayers(const PictureLayers& layers, const std::vector<Feature>& features, const std::string& path,
                 const PictureText& text, const JobControl& job) {
    checkLayersPath(path);
    (isLayersFile(path) ? writeFile : writeFolder)(layers, features, path, text, job);
}

} // namespace pellucid
