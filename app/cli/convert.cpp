// `convert`: a volume or a transfer function in another file format.
#include <filesystem>
#include <optional>

#include "commands.h"
#include "convert_tf.h"
#include "output_files.h"
#include "parse.h"
#include "resolve.h"
#include "volume/volume_writer.h"

namespace pellucid::cli {

namespace {

struct ConvertArguments {
    SceneOptions scene;
    std::optional<SampleType> type;
    bool allFrames = false;
    std::string out;
    std::optional<std::string> to, volume; ///< of a transfer function
};

/// Of a file, or of all that is in a folder.
std::uintmax_t bytesAt(const std::string& path, std::error_code& ec) {
    namespace fs = std::filesystem;
    if (!fs::is_directory(path, ec)) return fs::file_size(path, ec);
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path, ec))
        if (entry.is_regular_file(ec)) bytes += entry.file_size(ec);
    return bytes;
}

Answer run(const ConvertArguments& o, Progress& progress) {
    if (o.out.empty()) throw UsageError("the file name is empty", "--out", "name the file to write");
    if (!o.to) atOption("--out " + o.out, [&] { checkVolumeSuffix(o.out); });
    addOutputFile(o.out, "--out");
    refuse({{o.volume && !o.to, "only a transfer function is converted for a volume", "--volume", "add --to NAME"},
            {o.to && o.type, "a transfer function has no samples", "--type", "leave it out"},
            {o.to && o.allFrames, "one transfer function is converted", "--all-frames", "leave it out"},
            {o.allFrames && o.scene.volume.frame, "one frame and all frames are asked for", "--all-frames",
             "leave out one of --frame and --all-frames"}});
    if (o.to) return convertTf({*o.to, o.volume}, o.scene, o.out, progress);
    const Opened opened = resolve(o.scene, progress, {.use = {}, .byEngine = false, .needsTf = false});
    const Volume& volume = *opened.scene.volume;
    std::vector<std::string> notices = opened.notices();
    const WrittenPart part{.type = o.type};
    TimeSeries& series = *opened.scene.series;
    if (series.varies() && !o.allFrames && !o.scene.volume.frame) {
        const int frame = opened.scene.session.frame;
        notices.push_back("frame " + std::to_string(frame) + " of " + std::to_string(series.size()) + " (" +
                          series.listing().label(frame) +
                          ") is written: --all-frames writes all, --frame N another one");
    }
    const int frames = o.allFrames ? series.size() : 1;
    const JobControl writing = progress.phase("writing");
    const std::vector<std::string> lost = o.allFrames ? writeSeries(series, o.out, part, writing, volume.notices)
                                                      : writeVolume(volume, o.out, part, writing);
    notices.insert(notices.end(), lost.begin(), lost.end());
    const SampleType type = o.type.value_or(volume.sampleType());
    std::error_code ec;
    const std::uintmax_t bytes = bytesAt(o.out, ec);
    Json json{{"command", "convert"},
              {"file", o.out},
              {"dims", jsonFromDims(volume.dims())},
              {"type", name(type)},
              {"spacing", jsonFromVector(volume.geometry().spacing)}};
    if (!ec) json["file_bytes"] = bytes;
    if (o.allFrames) json["frames"] = frames;
    return {"wrote " + o.out + ": " + dimsText(volume.dims()) + " voxels, " + name(type) +
                (frames > 1 ? ", " + std::to_string(frames) + " frames" : "") + (ec ? "" : ", " + bytesText(bytes)) +
                "\n",
            std::move(json), std::move(notices)};
}

} // namespace

Command addConvert(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "convert", "Writes a volume in another file format, or a part of it; or a transfer function");
    const auto o = std::make_shared<ConvertArguments>();
    o->scene.addForData(*app);
    addValue(
        *app, "--type", "TYPE",
        [o](const std::string& text, const std::string& option) { o->type = parseName<SampleType>(text, option); },
        "type of the samples: u8 i8 u16 i16 u32 i32 f32 f64; what is rounded or cut is said (default: their own)");
    app->add_flag("--all-frames", o->allFrames,
                  "all frames, or those of --frames, in one file; as VTK image data a file each, and a .pvd");
    addValue(*app, "--to", "NAME", o->to, anyText,
             "VOLUME is a transfer function (a file, auto, tents:N, ramp:N or preset:NAME), which is written for: " +
                 tfFormatNames());
    addValue(*app, "--volume", "FILE", o->volume, anyText,
             "with --to: the volume that it is for, whose range and spacing go along; other options of the volume are "
             "of this one");
    addValue(*app, "--out", "FILE", o->out, anyText,
             "the file to write: .nrrd .mha .mhd .nii .nii.gz .vti .pvd .tif .zarr, or with --to any")
        ->required();
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
