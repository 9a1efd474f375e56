// `thumbnail`: a small picture of a file, for file managers.
#include <algorithm>

#include "base/atomic_file.h"
#include "base/text.h"
#include "commands.h"
#include "image_io/image_file.h"
#include "output_files.h"
#include "parse.h"
#include "render/image_renderer.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "session/session_json.h"
#include "session/variable_edits.h"
#include "volume/file_contents.h"
#include "volume/file_names.h"

namespace pellucid::cli {

namespace {

/// Along the longest axis: more cannot be told apart at the usual sizes, and take longer.
constexpr int kVoxels = 96;
constexpr int kLargestSize = 2048;
/// In d0: a sixth of the time of the usual one, for pictures that no one can tell apart at this size (SSIM 0.9999).
constexpr double kFinestStep = 0.5;

struct ThumbnailArguments {
    std::string in, out;
    int size = 256;
};

bool isSession(const std::string& path) { return lowerCase(path).ends_with(".pellucid.json"); }

/// How many voxels along each axis become one.
int factorFor(const VolumeSource& source, int size, const JobControl& job) {
    if (source.isSample()) return 1;
    const Int3 dims = contentsOf(source, job).dims;
    const int most = std::max(kVoxels, size * kVoxels / 256);
    return std::max(1, (std::max({dims.x, dims.y, dims.z}) + most - 1) / most);
}

SceneOptions sceneOf(const ThumbnailArguments& o, const JobControl& job) {
    SceneOptions options;
    VolumeSource source;
    if (isSession(o.in)) {
        options.sessionFile = o.in;
        source = dataVariable(readSession(o.in).session).source;
    } else {
        options.volume.path = source.path = o.in;
    }
    options.volume.downsample = std::max(source.downsample, factorFor(source, o.size, job));
    options.picture.size = {o.size, o.size};
    return options;
}

Answer run(const ThumbnailArguments& o, Progress& progress) {
    const Stopwatch total;
    // The format is asked of a program of its own where it is not ours, so that this may take a moment, too.
    const SceneOptions options = sceneOf(o, progress.phase("reading the header"));
    const Opened opened = resolve(options, progress, {toView("drawing")});
    PictureInput picture = options.picture.pictureOf(opened.scene);
    picture.settings.finestInD0 = kFinestStep;
    const Stopwatch drawing;
    // A software OpenGL takes longer to start than this picture takes.
    const Image image = makeCpuRenderer(picture.volume)
                            ->render(picture.camera, picture.tf, picture.settings, progress.phase("rendering"));
    const double seconds = drawing.seconds();
    progress.phase("writing");
    writeBytesAtomically(o.out, pngOf(image));
    return {"wrote " + o.out + ": " + std::to_string(o.size) + " x " + std::to_string(o.size) + " pixels of " +
                dimsText(opened.scene.volume->dims()) + " voxels, " + secondsText(total.seconds()) + "\n",
            {{"command", "thumbnail"},
             {"file", o.out},
             {"size", {o.size, o.size}},
             {"volume", jsonFromVolume(*opened.scene.volume)},
             {"downsample", *options.volume.downsample},
             {"seconds", {{"render", seconds}, {"total", total.seconds()}}}}};
}

} // namespace

Command addThumbnail(CLI::App& program) {
    CLI::App* app = program.add_subcommand("thumbnail", "Writes a small picture of a file, for file managers");
    const auto o = std::make_shared<ThumbnailArguments>();
    app->add_option_function<std::string>(
           "IN", [o](const std::string& text) { o->in = pathOfUrl(text); },
           "a volume that says itself what it is, or a session")
        ->required()
        ->type_name("");
    app->add_option_function<std::string>(
           "OUT",
           [o](const std::string& text) {
               if (text.empty()) throw UsageError("the file name is empty", "OUT", "name the file to write");
               addOutputFile(text, "OUT");
               o->out = text;
           },
           "the PNG file to write, whatever its suffix")
        ->required()
        ->type_name("");
    addValue(*app, "--size", "N", o->size, wholeFrom(16, kLargestSize), "pixels along each side (default 256)");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
