// saliency_pictures DIR: twenty pictures of three samples with those of their features, and what their 2D feature
// saliency is, as files that image_saliency.py evaluates anew. Each case is one line of DIR/cases.txt: name, width,
// height, features, FS …; the numbers are in DIR/NAME.f32, little-endian floats: R, G, B of the picture, then R, G, B,
// A of each feature alone, then S.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "render/feature_pictures.h"
#include "session/scene.h"

using namespace pellucid;

namespace {

void put(std::ofstream& out, const std::vector<float>& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(float)));
}

} // namespace

int main(int argc, char** argv) try {
    if (argc != 2) throw UsageError("no folder is named", "saliency_pictures", "give one");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    std::ofstream cases(folder / "cases.txt");
    cases.precision(9);
    const char* const samples[] = {"sample:shells", "sample:knee", "sample:disks"};
    const char* const functions[] = {"tents:3", "ramp:4", "tents:5:0.3", "auto"};
    const int sizes[][2] = {{512, 512}, {301, 211}, {257, 400}, {640, 480}, {99, 97}};
    for (std::size_t n = 0; n < 20; ++n) {
        VolumeSource source;
        source.path = samples[n % std::size(samples)];
        source.sampleSize = 64;
        SceneInputs inputs;
        inputs.session = sessionOf(source);
        inputs.tf = functions[n % std::size(functions)];
        inputs.view = ViewAngles{40.0 * static_cast<double>(n), 15.0 * static_cast<double>(n % 7) - 45};
        const Scene scene = openScene(inputs);
        const auto [width, height] = sizes[n % std::size(sizes)];
        PictureInput picture = pictureInput(scene, width, height);
        picture.settings.light.on = n % 2 == 1;
        const FeaturePictures pictures =
            featurePictures(*makeCpuRenderer(picture.volume), picture.camera, picture.tf, picture.settings);
        const FeatureSaliency saliency = featureSaliency(pictures);

        const std::string name = "case" + std::to_string(n);
        cases << name << ' ' << width << ' ' << height << ' ' << saliency.shares.size();
        for (const double share : saliency.shares) cases << ' ' << share;
        cases << '\n';
        std::ofstream out(folder / (name + ".f32"), std::ios::binary);
        std::vector<float> rgb;
        for (std::size_t i = 0; i < pictures.whole.rgba.size(); ++i)
            if (i % 4 != 3) rgb.push_back(pictures.whole.rgba[i]);
        put(out, rgb);
        for (const Image& image : pictures.alone) put(out, image.rgba);
        put(out, saliency.map.values);
    }
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "saliency_pictures: %s\n", e.what());
    return 1;
}
