// `generate`: a built-in data set as a file.
#include <filesystem>
#include <optional>

#include "commands.h"
#include "output_files.h"
#include "parse.h"
#include "volume/file_names.h"
#include "volume/loader.h"
#include "volume/procedural.h"

namespace pellucid::cli {

namespace {

struct GenerateArguments {
    std::string name;
    int size = 0;
    std::uint32_t seed = 1;
    std::optional<int> frames;
    std::string out;
};

void checkSuffix(const std::string& path) {
    if (std::filesystem::path(path).extension() != ".nrrd")
        throw UsageError("a sample is written as NRRD, but '" + path + "' has another suffix", "--out",
                         "name the file something.nrrd");
}

/// The file of a frame: the pattern's conversion, else "_007" before the suffix.
std::string fileOf(const std::string& out, int frame) {
    if (const auto pattern = numberedName(out)) return pattern->with(frame);
    const std::filesystem::path path(out);
    std::string number = std::to_string(frame);
    number.insert(0, number.size() < 3 ? 3 - number.size() : 0, '0');
    return (path.parent_path() / (path.stem().string() + "_" + number + path.extension().string())).string();
}

Answer run(const GenerateArguments& o, Progress& progress) {
    if (o.out.empty()) throw UsageError("the file name is empty", "--out", "name the file to write");
    checkSuffix(o.out);
    const SampleInfo& info = sampleInfo(o.name);
    if (o.frames && *o.frames > info.frames)
        throw UsageError("the sample has " + std::to_string(info.frames) + " frames", "--frames",
                         "give 1 to " + std::to_string(info.frames));
    std::vector<std::string> files;
    for (int f = 0; f < o.frames.value_or(1); ++f) files.push_back(o.frames ? fileOf(o.out, f) : o.out);
    for (const std::string& file : files) addOutputFile(file, "--out");
    const JobControl job = progress.phase("generating");
    std::uintmax_t bytes = 0;
    std::optional<Volume> volume;
    bool areFiles = true; // no pipes or devices
    for (std::size_t f = 0; f < files.size(); ++f) {
        volume.emplace(makeSample(o.name, o.size, o.seed, job.part(f, files.size()), {}, static_cast<int>(f)));
        if (files.size() == 1) progress.phase("writing");
        writeNrrd(*volume, files[f]);
        std::error_code notAFile;
        const std::uintmax_t size = std::filesystem::file_size(files[f], notAFile);
        areFiles = areFiles && !notAFile;
        if (!notAFile) bytes += size;
    }
    Json json{{"command", "generate"},
              {"name", o.name},
              {"file", files.front()},
              {"file_bytes", areFiles ? Json(bytes) : Json()},
              {"dims", jsonFromDims(volume->dims())},
              {"type", name(volume->sampleType())},
              {"spacing", jsonFromVector(volume->geometry().spacing)}};
    if (o.frames) json["files"] = files;
    const std::string what = files.size() == 1
                                 ? files.front()
                                 : std::to_string(files.size()) + " frames, " + files.front() + " to " + files.back();
    return {"wrote " + what + ": " + dimsText(volume->dims()) + " voxels, " + name(volume->sampleType()) +
                (areFiles ? ", " + bytesText(bytes) : "") + "\n",
            std::move(json)};
}

} // namespace

Command addGenerate(CLI::App& program) {
    CLI::App* app = program.add_subcommand("generate", "Writes a built-in volume as a NRRD file");
    const auto o = std::make_shared<GenerateArguments>();
    app->add_option_function<std::string>(
           "NAME", [o](const std::string& text) { o->name = text.starts_with("sample:") ? text.substr(7) : text; },
           "a name that `pellucid-cli samples` lists")
        ->required()
        ->type_name("");
    addValue(*app, "--size", "N", o->size, wholeFrom(8, 65536),
             "voxels along the longest axis (default: the sample's own)");
    addValue(*app, "--frames", "N", o->frames, wholeFrom(1, 1'000'000),
             "the first N time steps, a file each: --out is a pattern (f_%03d.nrrd) or gets _000, _001 …");
    addValue(*app, "--seed", "N", o->seed, wholeFrom<std::uint32_t>(0, 4294967295), "seed of the noise (default 1)");
    addValue(*app, "--out", "FILE", o->out, anyText, "the file to write, *.nrrd")->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
