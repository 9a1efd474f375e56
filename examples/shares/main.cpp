// shares VOLUME [TF]: what each feature of a transfer function shows from the view that the volume opens on.
//
// VOLUME is a file or sample:NAME. TF is a file, tents:N, preset:NAME or auto, which is what the data propose.
#include <cstdio>
#include <exception>

#include <base/error.h>
#include <session/scene.h>
#include <session/workspace.h>
#include <volume/loader.h>

namespace {

void printShares(const char* volume, const char* tf) {
    pellucid::VolumeSource source;
    source.path = volume;

    pellucid::SceneInputs inputs;
    inputs.session = pellucid::sessionOf(source);
    inputs.tf = tf;
    const pellucid::Scene scene = pellucid::openScene(inputs);

    pellucid::Workspace workspace;
    const pellucid::Measures measures = workspace.measure(pellucid::measureInput(scene));

    std::printf("%-20s %10s %8s %8s\n", "feature", "visibility", "VWS", "opacity");
    for (std::size_t i = 0; i < scene.tf.features.size(); ++i)
        std::printf("%-20s %10.4f %8.4f %8.4f\n", scene.tf.features[i].name.c_str(), measures.features[i].visibility,
                    measures.features[i].vws, measures.opacities[i]);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::fprintf(stderr, "usage: shares VOLUME [TF]\n");
        return 2;
    }
    try {
        printShares(argv[1], argc > 2 ? argv[2] : pellucid::kAutomaticTf);
    } catch (const pellucid::Error& error) { // says what is wrong, where, and what to do
        std::fprintf(stderr, "shares: error: %s\n", error.what());
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "shares: error: %s\n", error.what());
        return 1;
    }
    return 0;
}
