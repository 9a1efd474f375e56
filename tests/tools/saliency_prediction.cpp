// saliency_prediction [VOLUME …]: how well VWS and feature visibility of the volume predict 2D feature saliency of the
// picture. Ten random scenes of each volume (a file or sample:NAME; six samples by default): view, number of features,
// opacities and light by seed. One line per volume, then all: pairs of a scene and a feature, Spearman's rank
// correlation with its 95 % interval and p, of VWS and of FV with 2DFS.
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "base/error.h"
#include "base/statistics.h"
#include "render/feature_pictures.h"
#include "session/scene.h"
#include "session/workspace.h"

using namespace pellucid;

namespace {

constexpr int kScenes = 10;

struct Figures {
    std::vector<double> vws, visibility, picture;

    void add(const Figures& other) {
        vws.insert(vws.end(), other.vws.begin(), other.vws.end());
        visibility.insert(visibility.end(), other.visibility.begin(), other.visibility.end());
        picture.insert(picture.end(), other.picture.begin(), other.picture.end());
    }
    void print(const std::string& title) const {
        std::printf("%-24s %4zu pairs", title.c_str(), picture.size());
        for (const auto& [name, values] : {std::pair{"VWS", &vws}, std::pair{"FV", &visibility}}) {
            const Correlation c = correlation(CorrelationKind::Spearman, *values, picture);
            std::printf("   %s %.3f (%.3f to %.3f), p %.1e", name, c.value, c.interval.low, c.interval.high, c.p);
        }
        std::printf("\n");
        std::fflush(stdout);
    }
};

/// [0,1), the same everywhere.
double unit(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

Figures figuresOf(const std::string& path, std::mt19937& random) {
    Figures figures;
    for (int n = 0; n < kScenes; ++n) {
        VolumeSource source;
        source.path = path;
        SceneInputs inputs;
        inputs.session = sessionOf(source);
        inputs.tf = "tents:" + std::to_string(2 + static_cast<int>(4 * unit(random)));
        inputs.view = ViewAngles{360 * unit(random), std::asin(2 * unit(random) - 1) * 180 / 3.14159265358979};
        Scene scene = openScene(inputs);
        std::vector<double> opacities(scene.tf.features.size());
        for (double& x : opacities) x = std::pow(10, -2.3 + 2.2 * unit(random)); // 0.005 to 0.8
        scene.tf = withFeatureOpacities(scene.tf, opacities);
        PictureInput picture = pictureInput(scene, 512, 512);
        picture.settings.light.on = unit(random) < 0.5;
        const FeatureSaliency saliency = featureSaliency(
            featurePictures(*makeCpuRenderer(picture.volume), picture.camera, picture.tf, picture.settings));
        Workspace workspace;
        const Measures measures = workspace.measure(measureInput(scene));
        for (std::size_t f = 0; f < saliency.shares.size(); ++f) {
            if (scene.isEmpty(f)) continue;
            figures.vws.push_back(measures.features[f].vws);
            figures.visibility.push_back(measures.features[f].visibility);
            figures.picture.push_back(saliency.shares[f]);
        }
    }
    return figures;
}

} // namespace

int main(int count, char** arguments) try {
    std::vector<std::string> volumes(arguments + 1, arguments + count);
    if (volumes.empty())
        volumes = {"sample:shells", "sample:disks", "sample:knee", "sample:vortex", "sample:smoke", "sample:hurricane"};
    std::mt19937 random(1);
    Figures all;
    for (const std::string& volume : volumes) {
        const Figures figures = figuresOf(volume, random);
        figures.print(volume.substr(volume.rfind('/') + 1));
        all.add(figures);
    }
    all.print("all");
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "saliency_prediction: %s\n", e.what());
    return 1;
}
