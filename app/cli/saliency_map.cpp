// `saliency-map`: what catches the eye in a picture.
#include <algorithm>

#include "commands.h"
#include "image_io/image_file.h"
#include "output_files.h"
#include "saliency/image_saliency.h"

namespace pellucid::cli {

namespace {

struct SaliencyMapArguments {
    std::string image, out;
};

Answer run(const SaliencyMapArguments& o, Progress& progress) {
    const Stopwatch total;
    addInputFile(o.image);
    const Image image = readImage(o.image);
    const Plane map = saliencyMap(image, progress.phase("saliency"));
    writePlane(map, o.out);
    const auto most = std::ranges::max_element(map.values);
    const auto at = static_cast<int>(most - map.values.begin());
    const int x = at % map.width, y = at / map.width;
    Json json{{"command", "saliency-map"},
              {"image", o.image},
              {"file", o.out},
              {"size", {map.width, map.height}},
              {"largest", *most},
              {"at", {x, y}},
              {"seconds", {{"total", total.seconds()}}}};
    return {"wrote " + o.out + ": " + std::to_string(map.width) + " x " + std::to_string(map.height) +
                " pixels, largest saliency " + fixedText(static_cast<double>(*most), 4) + " at " + std::to_string(x) +
                "," + std::to_string(y) + "\n",
            std::move(json)};
}

} // namespace

Command addSaliencyMap(CLI::App& program) {
    CLI::App* app = program.add_subcommand("saliency-map", "What catches the eye in a picture, as a map");
    const auto o = std::make_shared<SaliencyMapArguments>();
    app->add_option("IMAGE", o->image, "a picture: PNG, TIFF, EXR, JPEG or another that OpenImageIO reads")
        ->required()
        ->type_name("");
    addOutputFile(*app, "--out", o->out,
                  "the map to write: .exr (saliency from 0 to 1, 32-bit floats) or .png (times 65535, 16 bits)",
                  checkPlaneSuffix)
        ->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
