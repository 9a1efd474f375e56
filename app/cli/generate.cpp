// `generate`: a built-in data set as a file.
#include <filesystem>

#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "volume/loader.h"
#include "volume/procedural.h"

namespace pellucid::cli {

namespace {

struct Options {
    std::string name;
    int size = 0;
    std::uint32_t seed = 1;
    std::string out;
};

void checkSuffix(const std::string& path) {
    if (std::filesystem::path(path).extension() != ".nrrd")
        throw UsageError("a sample is written as NRRD, '" + path + "' has another suffix", "--out",
                         "name the file something.nrrd");
}

Answer run(const Options& o, Progress& progress) {
    requireFileName(o.out, "--out");
    checkSuffix(o.out);
    checkOutputFile(o.out, "--out");
    const Volume volume = makeSample(o.name, o.size, o.seed, progress.phase("generating"));
    progress.phase("writing");
    writeNrrd(volume, o.out);
    std::error_code notAFile; // but a pipe or device
    const std::size_t bytes = std::filesystem::file_size(o.out, notAFile);
    Json json{{"command", "generate"},
              {"name", o.name},
              {"file", o.out},
              {"file_bytes", notAFile ? Json() : Json(bytes)},
              {"dims", jsonFromDims(volume.dims())},
              {"type", name(volume.sampleType())},
              {"spacing", jsonFromVector(volume.geometry().spacing)}};
    return {"wrote " + o.out + ": " + dimsText(volume.dims()) + " voxels, " + name(volume.sampleType()) +
                (notAFile ? "" : ", " + bytesText(bytes)) + "\n",
            std::move(json),
            {},
            {}};
}

} // namespace

Command addGenerate(CLI::App& program) {
    CLI::App* app = program.add_subcommand("generate", "Writes a built-in volume as a NRRD file");
    const auto o = std::make_shared<Options>();
    app->add_option_function<std::string>(
           "NAME", [o](const std::string& text) { o->name = text.starts_with("sample:") ? text.substr(7) : text; },
           "a name that `pellucid-cli samples` lists")
        ->required()
        ->type_name("");
    addValue(
        *app, "--size", "N",
        [o](const std::string& text, const std::string& option) {
            o->size = static_cast<int>(parseInteger(text, option, 8, 65536));
        },
        "voxels along the longest axis (default: the sample's own)");
    addValue(
        *app, "--seed", "N",
        [o](const std::string& text, const std::string& option) {
            o->seed = static_cast<std::uint32_t>(parseInteger(text, option, 0, 4294967295));
        },
        "seed of the noise (default 1)");
    addValue(
        *app, "--out", "FILE", [o](const std::string& text, const std::string&) { o->out = text; },
        "the file to write, *.nrrd")
        ->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
