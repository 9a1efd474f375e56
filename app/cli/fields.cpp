// `fields`: what every voxel contributes, as volumes to look at.
#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "base/text.h"
#include "base/utf8.h"
#include "commands.h"
#include "optimize/fields.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "volume/volume_writer.h"
#include "volume/write_field.h"

namespace pellucid::cli {

namespace {

namespace fs = std::filesystem;

struct FieldsArguments {
    SceneOptions scene;
    std::string out;
    std::vector<std::string> features; ///< names, or "all"
    std::vector<FieldKind> kinds;      ///< empty: kUsual
    std::string suffix = ".nrrd";      ///< of the files
};

constexpr std::array kUsual{FieldKind::Visibility, FieldKind::SaliencyBrightness, FieldKind::SaliencySaturation,
                            FieldKind::Vws};

/// One file: all of a field, or what it is in one feature.
struct Output {
    FieldKind kind;
    int feature = -1; ///< −1: all
    std::string file;
};

/// A feature's name as part of a file name, on any system: without what only steers how a text is shown.
std::string safeName(const std::string& name) {
    constexpr std::size_t kMost = 80;
    std::string safe;
    for (const char c : printable(name)) {
        const bool harmful =
            static_cast<unsigned char>(c) <= ' ' || std::string(R"(/\:*?"<>|)").find(c) != std::string::npos;
        safe += harmful ? '_' : c;
    }
    safe = cutAtCharacter(std::move(safe), kMost);
    return safe.empty() ? "_" : safe;
}

std::vector<int> featuresOf(const FieldsArguments& o, const TransferFunction& tf) {
    std::vector<int> chosen;
    const auto add = [&](int f) {
        if (std::find(chosen.begin(), chosen.end(), f) == chosen.end()) chosen.push_back(f);
    };
    for (const std::string& name : o.features) {
        if (name != "all") {
            add(static_cast<int>(parseFeature(name, "--feature", tf)));
            continue;
        }
        for (std::size_t f = 0; f < tf.features.size(); ++f) add(static_cast<int>(f));
    }
    return chosen;
}

/// All of each field, in the order of the kinds, then the features. No two files have the same name.
std::vector<Output> outputsOf(const std::vector<FieldKind>& kinds, const std::vector<int>& features,
                              const TransferFunction& tf, const std::string& suffix) {
    std::vector<Output> outputs;
    std::set<std::string> taken;
    const auto add = [&](FieldKind kind, int feature, const std::string& stem) {
        std::string file = stem + suffix;
        for (int n = 2; !taken.insert(file).second; ++n) file = stem + "_" + std::to_string(n) + suffix;
        outputs.push_back({kind, feature, file});
    };
    for (const FieldKind kind : kinds) add(kind, -1, fileStem(kind));
    for (const FieldKind kind : kinds)
        for (const int f : features)
            add(kind, f, fileStem(kind) + "_" + safeName(tf.features[static_cast<std::size_t>(f)].name));
    return outputs;
}

Answer run(const FieldsArguments& o, Progress& progress) {
    const Stopwatch total;
    const std::vector<FieldKind> kinds =
        o.kinds.empty() ? std::vector<FieldKind>(kUsual.begin(), kUsual.end()) : o.kinds;
    const auto announce = [&](const Output& output) { addOutputFile(o.out, output.file, "--out"); };
    for (const Output& output : outputsOf(kinds, {}, {}, o.suffix)) announce(output);
    const Opened opened = resolve(o.scene, progress, {toWriteFields(), true});
    const MeasureInput input = measureInput(opened.scene);
    const std::vector<Output> outputs = outputsOf(kinds, featuresOf(o, input.tf), input.tf, o.suffix);
    for (const Output& output : outputs)
        if (output.feature >= 0) announce(output);
    Workspace workspace;
    const std::string engineName = prepare(workspace, input, progress).engine;
    const WeightFields& weights = workspace.weights(input);
    Grid<float> visibility;
    if (std::any_of(kinds.begin(), kinds.end(), dependsOnView))
        visibility = workspace.engine(input).field(input.view, input.tf, progress.phase("visibility")).values;
    workspace.releaseEngine(); // and one file after the other: the program keeps no more fields than it needs

    const VoxelsElsewhere* const elsewhere = input.volume->elsewhere();
    const OutputFolder folder(o.out);
    const JobControl writing = progress.phase("writing");
    std::string text;
    std::vector<std::string> notices = opened.notices();
    const auto write = [&](const Grid<float>& values, const std::string& path) {
        for (const std::string& lost : writeField(*input.volume, values, path)) // the same of all of them
            if (std::find(notices.begin(), notices.end(), lost) == notices.end()) notices.push_back(lost);
    };
    Json names = Json::array();
    for (const Output& output : outputs) {
        writing.throwIfStopped();
        writing.report(static_cast<double>(names.size()) / static_cast<double>(outputs.size()));
        const std::string path = (fs::path(o.out) / output.file).string();
        const JobControl stop{writing.stop, {}};
        if (output.kind == FieldKind::Visibility && output.feature < 0) {
            write(visibility, path);
        } else {
            Grid<float> values = dependsOnView(output.kind)
                                     ? visibility
                                     : saliencyGrid(weights, output.kind, input.settings.vws, stop, elsewhere);
            if (output.kind == FieldKind::Vws) visibilityToVws(values, weights, input.settings.vws, stop, elsewhere);
            keepFeature(values, *input.volume, input.tf, output.feature, stop);
            write(values, path);
        }
        text += "wrote " + path + "\n";
        names.push_back(path);
    }
    Json json{{"command", "fields"},
              {"engine", engineName},
              {"volume", jsonFromVolume(*input.volume)},
              {"files", names},
              {"seconds", {{"total", total.seconds()}}}};
    addProfile(json, input.settings);
    addMapping(json, opened.scene);
    return {text, std::move(json), std::move(notices)};
}

} // namespace

Command addFields(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "fields",
        "Writes visibility, saliency and each voxel's share of the VWS as volumes (float32, the volume's grid)");
    const auto o = std::make_shared<FieldsArguments>();
    o->scene.addForFigures(*app);
    addOutputFolder(
        *app, "--out", o->out,
        "folder for visibility.nrrd, saliency_brightness.nrrd, saliency_saturation.nrrd, vws.nrrd; made where missing")
        ->required();
    addRepeated(
        *app, "--feature", "NAME", o->features, anyText,
        "also the voxels of this feature alone, 0 elsewhere: visibility_NAME.nrrd and so on; repeatable; all: of each "
        "feature");
    addRepeated(
        *app, "--field", joined(kNamesOf<FieldKind>.names, "|"),
        [o](const std::string& text, const std::string& option) {
            const auto kind = parseName<FieldKind>(text, option);
            if (std::find(o->kinds.begin(), o->kinds.end(), kind) == o->kinds.end()) o->kinds.push_back(kind);
        },
        "this field alone; repeatable (default: all but saliency, the sum of both with the weights u1 and u2)");
    addValue(
        *app, "--format", "SUFFIX",
        [o](const std::string& text, const std::string& option) {
            o->suffix = text.starts_with('.') ? text : "." + text;
            atOption(option + " " + text, [&] { checkVolumeSuffix("a" + o->suffix); });
        },
        "format of the files: nrrd, mha, mhd, nii, nii.gz, vti, tif, zarr (default: nrrd)");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
