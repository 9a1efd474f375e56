// `fields`: what every voxel contributes, as volumes to look at.
#include <filesystem>
#include <functional>

#include "commands.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

namespace fs = std::filesystem;

struct Options {
    SceneOptions scene;
    std::string out;
};

void checkFolder(const std::string& path) {
    if (path.empty()) throw UsageError("the folder name is empty", "--out", "name the folder to write to");
    std::error_code ec;
    if (fs::is_directory(path, ec)) return;
    if (fs::exists(path, ec)) throw FileError("a file has the folder's name", path, "choose another name");
    const fs::path parent =
        fs::path(path).has_filename() ? fs::path(path).parent_path() : fs::path(path).parent_path().parent_path();
    if (!parent.empty() && !fs::is_directory(parent, ec))
        throw FileError("the folder does not exist", parent.string(), "create it first");
}

void createFolder(const std::string& path) {
    std::error_code ec;
    fs::create_directory(path, ec);
    if (ec && !fs::is_directory(path))
        throw FileError("cannot create the folder (" + ec.message() + ")", path, "check permissions and space");
}

double sumOfProducts(const Grid<float>& visibility, const WeightFields& weights, int attribute) {
    double sum = 0;
    for (std::size_t i = 0; i < visibility.size(); ++i)
        sum += static_cast<double>(visibility[i]) * weights.at(attribute, i);
    return sum;
}

/// Each voxel's share of the visibility-weighted saliency: u1·v·L_b / Σ v·L_b + u2·v·L_s / Σ v·L_s, so that the sum
/// over the voxels of a feature is its W_F (MEASURES §6, with its rule for an attribute whose sum is 0).
Grid<float> vwsField(const Grid<float>& visibility, const WeightFields& weights, const VwsOptions& options) {
    const double brightness = sumOfProducts(visibility, weights, 0);
    const double saturation = sumOfProducts(visibility, weights, 1);
    const auto [u1, u2] = attributeWeights({brightness, saturation}, options);
    const double b = brightness > 0 ? u1 / brightness : 0.0;
    const double s = saturation > 0 ? u2 / saturation : 0.0;
    Grid<float> field(visibility.dims());
    for (std::size_t i = 0; i < field.size(); ++i)
        field[i] = static_cast<float>(visibility[i] * (b * weights.brightness(i) + s * weights.saturation(i)));
    return field;
}

Answer run(const Options& o, Progress& progress) {
    const Stopwatch total;
    checkFolder(o.out);
    const Opened opened = resolve(o.scene, progress, {"measuring", kFieldsBytesPerVoxel, true});
    const MeasureInput input = measureInput(opened.scene);
    Workspace workspace;
    const std::string engineName = prepare(workspace, input, progress).engine;
    const WeightFields& weights = workspace.weights(input);
    const VisibilityField visibility =
        workspace.engine(input).field(input.camera, input.tf, progress.phase("visibility"));
    workspace.releaseEngine(); // and one file after the other: the program keeps no more fields than it needs

    createFolder(o.out);
    using Make = std::function<Grid<float>()>;
    const std::vector<std::pair<const char*, Make>> files{
        {"saliency_brightness.nrrd", [&] { return gridOf(weights, 0); }},
        {"saliency_saturation.nrrd", [&] { return gridOf(weights, 1); }},
        {"vws.nrrd", [&] { return vwsField(visibility.values, weights, input.settings.vws); }}};
    const JobControl writing = progress.phase("writing");
    std::string text;
    Json names = Json::array();
    const auto write = [&](const char* file, const Grid<float>& values) {
        writing.throwIfStopped();
        writing.report(static_cast<double>(names.size()) / static_cast<double>(files.size() + 1));
        const std::string path = (fs::path(o.out) / file).string();
        writeNrrd(input.volume->geometry(), values, path);
        text += "wrote " + path + "\n";
        names.push_back(path);
    };
    write("visibility.nrrd", visibility.values);
    for (const auto& [file, make] : files) write(file, make());
    Json json{{"command", "fields"},
              {"engine", engineName},
              {"volume", jsonFromVolume(*input.volume)},
              {"files", names},
              {"seconds", {{"total", total.seconds()}}}};
    return {text, std::move(json), opened.notices(), {}};
}

} // namespace

Command addFields(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "fields",
        "Writes visibility, saliency and each voxel's share of the VWS as NRRD files (float32, the volume's grid)");
    const auto o = std::make_shared<Options>();
    o->scene.volume.add(*app);
    o->scene.session.add(*app);
    o->scene.tf.add(*app);
    o->scene.camera.add(*app);
    o->scene.engine.add(*app, "high: half the error, more time");
    o->scene.saliency.add(*app);
    addValue(
        *app, "--out", "DIR", [o](const std::string& text, const std::string&) { o->out = text; },
        "folder for visibility.nrrd, saliency_brightness.nrrd, saliency_saturation.nrrd, vws.nrrd; made where missing")
        ->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
