// `fields`: what every voxel contributes, as volumes to look at.
#include <array>
#include <filesystem>
#include <functional>

#include "commands.h"
#include "output_files.h"
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

/// In the order in which they are written.
const std::array<std::string, 4> kFiles{"visibility.nrrd", "saliency_brightness.nrrd", "saliency_saturation.nrrd",
                                        "vws.nrrd"};

/// A folder that goes again where nothing could be written into it.
class OutputFolder {
public:
    explicit OutputFolder(const std::string& path) : m_path(path) {
        std::error_code ec;
        m_isNew = fs::create_directory(path, ec);
        if (ec && !fs::is_directory(path))
            throw FileError("cannot create the folder (" + ec.message() + ")", path, "check permissions and space");
    }
    ~OutputFolder() {
        std::error_code ec;
        if (m_isNew) fs::remove(m_path, ec); // an empty one only
    }
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

private:
    fs::path m_path;
    bool m_isNew = false;
};

double sumOfProducts(const Grid<float>& visibility, const WeightFields& weights, int attribute) {
    double sum = 0;
    for (std::size_t i = 0; i < visibility.size(); ++i)
        sum += static_cast<double>(visibility[i]) * weights.at(attribute, i);
    return sum;
}

/// Each voxel's share of the visibility-weighted saliency: u1·v·L_b / Σ v·L_b + u2·v·L_s / Σ v·L_s, so that the sum
/// over the voxels of a feature is its W_F (docs/method.md, "Visibility-weighted saliency", with its rule for an
/// attribute whose sum is 0).
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
    checkOutputFolder(o.out, "--out", kFiles, inputFiles(o.scene));
    const Opened opened = resolve(o.scene, progress, {toWriteFields(), true});
    const MeasureInput input = measureInput(opened.scene);
    Workspace workspace;
    const std::string engineName = prepare(workspace, input, progress).engine;
    const WeightFields& weights = workspace.weights(input);
    const VisibilityField visibility =
        workspace.engine(input).field(input.view, input.tf, progress.phase("visibility"));
    workspace.releaseEngine(); // and one file after the other: the program keeps no more fields than it needs

    const OutputFolder folder(o.out);
    const std::array<std::function<Grid<float>()>, 3> makeOthers{
        [&] { return gridOf(weights, 0); }, [&] { return gridOf(weights, 1); },
        [&] { return vwsField(visibility.values, weights, input.settings.vws); }};
    const JobControl writing = progress.phase("writing");
    std::string text;
    Json names = Json::array();
    const auto write = [&](const Grid<float>& values) {
        writing.throwIfStopped();
        writing.report(static_cast<double>(names.size()) / static_cast<double>(kFiles.size()));
        const std::string path = (fs::path(o.out) / kFiles[names.size()]).string();
        writeNrrd(input.volume->geometry(), values, path);
        text += "wrote " + path + "\n";
        names.push_back(path);
    };
    write(visibility.values);
    for (const auto& make : makeOthers) write(make());
    Json json{{"command", "fields"},
              {"engine", engineName},
              {"volume", jsonFromVolume(*input.volume)},
              {"files", names},
              {"seconds", {{"total", total.seconds()}}}};
    addProfile(json, input.settings);
    return {text, std::move(json), opened.notices(), {}};
}

} // namespace

Command addFields(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "fields",
        "Writes visibility, saliency and each voxel's share of the VWS as NRRD files (float32, the volume's grid)");
    const auto o = std::make_shared<Options>();
    o->scene.addForFigures(*app);
    addValue(
        *app, "--out", "DIR", [o](const std::string& text, const std::string&) { o->out = text; },
        "folder for visibility.nrrd, saliency_brightness.nrrd, saliency_saturation.nrrd, vws.nrrd; made where missing")
        ->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
