#include "inputs.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "parse.h"
#include "tf/formats/tf_json.h"
#include "tf/sample_tf.h"

namespace pellucid::cli {

namespace {

constexpr const char* kVolumeGroup = "Volume";
constexpr const char* kViewGroup = "View";
constexpr const char* kEngineGroup = "Engine";
constexpr const char* kSaliencyGroup = "Saliency";

Vec3 parseSpacing(const std::string& text, const std::string& option) {
    const auto v = parseReals(text, option, 3, "SX,SY,SZ in world units");
    for (const double s : v)
        if (!(s > 0))
            throw UsageError("the spacing " + text + " is not positive", option, "give three numbers above 0");
    return {v[0], v[1], v[2]};
}

CameraOptions::View parseView(const std::string& text, const std::string& option) {
    const auto v = parseReals(text, option);
    const std::string form = "give AZIMUTH,ELEVATION[,ZOOM] in degrees";
    if (v.size() != 2 && v.size() != 3) throw UsageError("'" + text + "' is not a view", option, form);
    if (std::abs(v[1]) > 90) throw UsageError("the elevation is not between -90 and 90 degrees", option, form);
    CameraOptions::View view{v[0], v[1], v.size() == 3 ? v[2] : 1.0};
    if (!(view.zoom > 0))
        throw UsageError("the zoom is not above 0", option, "1 fits the whole volume, 2 is twice as large");
    return view;
}

bool isSample(const std::string& path) { return path.starts_with("sample:"); }

} // namespace

void VolumeOptions::add(CLI::App& app, SizeIs size) {
    app.add_option("VOLUME", path, "a NRRD, MetaImage, NIfTI or (with --raw) headerless file, or sample:NAME")
        ->required()
        ->type_name("");
    addValue(
        app, "--raw", "NX,NY,NZ,TYPE[,ENDIAN]",
        [this](const std::string& text, const std::string& option) {
            raw = atOption(option + " " + text, [&] { return parseRawLayout(text); });
        },
        "the file is headerless; TYPE is u8 i8 u16 i16 u32 i32 f32 f64, ENDIAN little (default) or big", kVolumeGroup);
    addValue(
        app, "--spacing", "SX,SY,SZ",
        [this](const std::string& text, const std::string& option) { spacing = parseSpacing(text, option); },
        "voxel distances of --raw data in world units (default 1,1,1)", kVolumeGroup);
    addValue(
        app, "--skip", "BYTES",
        [this](const std::string& text, const std::string& option) {
            skipBytes =
                static_cast<std::uint64_t>(parseInteger(text, option, 0, std::numeric_limits<long long>::max()));
        },
        "bytes before the --raw data", kVolumeGroup);
    addValue(
        app, "--missing", "VALUE",
        [this](const std::string& text, const std::string& option) { missing = parseReal(text, option); },
        "voxels of this value are invalid: never drawn, never counted", kVolumeGroup);
    addValue(
        app, "--range", "LO,HI",
        [this](const std::string& text, const std::string& option) { range = parseRange(text, option); },
        "the values of intensity 0 and 1 (default: those of the TF file, else smallest and largest value)",
        kVolumeGroup);
    addValue(
        app, "--component", "N",
        [this](const std::string& text, const std::string& option) {
            component = static_cast<int>(parseInteger(text, option, 0, 1'000'000));
        },
        "component of a multi-component file, from 0", kVolumeGroup);
    addValue(
        app, size == SizeIs::Sample ? "--size,--sample-size" : "--sample-size", "N",
        [this](const std::string& text, const std::string& option) {
            sampleSize = static_cast<int>(parseInteger(text, option, 8, 65536));
        },
        "voxels along the longest axis of a sample", kVolumeGroup);
    addValue(
        app, "--seed", "N",
        [this](const std::string& text, const std::string& option) {
            seed = static_cast<std::uint32_t>(parseInteger(text, option, 0, std::numeric_limits<std::uint32_t>::max()));
        },
        "seed of a sample's noise (default 1)", kVolumeGroup);
}

VolumeSource VolumeOptions::source(const MemoryUse& then) const {
    if (path.empty()) throw UsageError("the name of the volume is empty", "VOLUME", "name a file or sample:NAME");
    if (!raw && spacing) throw UsageError("--spacing is for headerless data", "--spacing", "give --raw as well");
    if (!raw && skipBytes) throw UsageError("--skip is for headerless data", "--skip", "give --raw as well");
    if (isSample(path) && raw) throw UsageError("a built-in sample is no headerless file", "--raw", "leave it out");
    if (!isSample(path) && sampleSize)
        throw UsageError("only built-in samples come in any size", "--sample-size", "leave it out or use sample:NAME");

    VolumeSource source;
    source.path = path;
    source.then = then;
    source.raw = raw;
    if (raw && spacing) source.raw->spacing = *spacing;
    if (raw && skipBytes) source.raw->skipBytes = *skipBytes;
    source.missing = missing;
    source.range = range;
    source.component = component;
    source.sampleSize = sampleSize.value_or(0);
    source.seed = seed;
    return source;
}

std::shared_ptr<const Volume> loadVolume(const VolumeOptions& options, Progress& progress, const MemoryUse& then) {
    return std::make_shared<const Volume>(pellucid::loadVolume(options.source(then), progress.phase("loading")));
}

void TfOptions::add(CLI::App& app) {
    addValue(
        app, "--tf", "FILE|tents:N[:PEAK]|ramp:N",
        [this](const std::string& text, const std::string& option) {
            if (text.empty()) throw UsageError("the name is empty", option, "give a file, tents:N[:PEAK] or ramp:N");
            spec = text;
        },
        "transfer function (default: the sample's own, else tents:3); intensities in a file refer to its \"range\", "
        "which becomes the window unless --range says otherwise",
        kVolumeGroup);
}

VolumeAndTf loadVolumeAndTf(const VolumeOptions& volumeOptions, const TfOptions& tfOptions, Progress& progress,
                            const MemoryUse& then) {
    // The transfer function first: it is small, and an error in it should not wait for a large volume.
    std::optional<TransferFunction> tf;
    if (tfOptions.spec) tf = loadTf(*tfOptions.spec);

    std::shared_ptr<const Volume> volume = loadVolume(volumeOptions, progress, then);
    if (tf && tf->range && !volumeOptions.range && *tf->range != volume->range())
        volume = std::make_shared<const Volume>(volume->withRange(*tf->range));
    if (!tf) tf = defaultTf(*volume);
    if (volume->range().lo < volume->range().hi) tf->range = volume->range();
    return {std::move(volume), std::move(*tf)};
}

void CameraOptions::add(CLI::App& app) {
    addValue(
        app, "--camera", "FILE", [this](const std::string& text, const std::string&) { file = text; },
        "camera file (JSON)", kViewGroup);
    addValue(
        app, "--view", "AZIMUTH,ELEVATION[,ZOOM]",
        [this](const std::string& text, const std::string& option) { view = parseView(text, option); },
        "degrees; 0,0 looks along +y from the front, z up; zoom 1 fits the box (default 30,20,1)", kViewGroup);
    app.add_flag("--orthographic", orthographic, "parallel rays (default: perspective)")->group(kViewGroup);
}

void CameraOptions::check() const {
    if (!file) return;
    if (view) throw UsageError("two views are given", "--camera and --view", "leave one out");
    if (orthographic)
        throw UsageError("a camera file states its own projection", "--orthographic", "leave it out or use --view");
    readCamera(*file);
}

Camera CameraOptions::camera(const Geometry& geometry) const {
    if (file) {
        const Camera camera = readCamera(*file);
        camera.validate(geometry, *file);
        return camera;
    }
    const View v = view.value_or(View{});
    const Camera camera = cameraFromView(geometry, v.azimuth, v.elevation, v.zoom,
                                         orthographic ? Projection::Orthographic : Projection::Perspective);
    try {
        camera.validate(geometry, "--view");
    } catch (const Error& e) {
        throw UsageError(e.problem(), e.where(), e.whatToDo());
    }
    return camera;
}

void EngineOptions::add(CLI::App& app, const std::string& qualityHelp) {
    addValue(
        app, "--engine", "auto|gl|cpu|reference",
        [this](const std::string& text, const std::string& option) {
            choice = atOption(option, [&] { return engineChoiceFromName(text); });
        },
        "what computes; auto (default): gl on a real GPU, else cpu", kEngineGroup);
    addValue(
        app, "--quality", "normal|high",
        [this](const std::string& text, const std::string& option) {
            if (text == "normal")
                quality = Quality::Normal;
            else if (text == "high")
                quality = Quality::High;
            else
                throw UsageError("unknown quality '" + text + "'", option, "give normal or high");
        },
        qualityHelp, kEngineGroup);
}

MemoryUse EngineOptions::memoryFor(const std::string& doing, double bytesPerVoxel) const {
    return {doing, bytesPerVoxel + (choice == EngineChoice::Reference ? kMoreByReferenceBytesPerVoxel : 0.0)};
}

void SaliencyInput::add(CLI::App& app) {
    addValue(
        app, "--sigma", "S",
        [this](const std::string& text, const std::string& option) {
            saliency.sigma = parseRealAbove(text, option, 0, 8);
        },
        "radius of the centre in reference lengths, at most 8 (default 2)", kSaliencyGroup);
    addValue(
        app, "--kernel", "thesis|narrow",
        [this](const std::string& text, const std::string& option) {
            if (text == "thesis")
                saliency.kernel = SaliencyKernel::Thesis;
            else if (text == "narrow")
                saliency.kernel = SaliencyKernel::Narrow;
            else
                throw UsageError("unknown kernel '" + text + "'", option, "give thesis or narrow");
        },
        "weights within the radius (default thesis)", kSaliencyGroup);
    const auto weight = [&](const char* name, double& target, const char* help) {
        addValue(
            app, name, "W",
            [&target](const std::string& text, const std::string& option) { target = parseReal(text, option, 0, 1e6); },
            help, kSaliencyGroup);
    };
    weight("--w1", saliency.w1, "weight of the centre (default 1)");
    weight("--w2", saliency.w2, "weight of the surround (default 1)");
    const auto share = [&](const char* name, std::optional<double>& target, const char* help) {
        addValue(
            app, name, "U",
            [&target](const std::string& text, const std::string& option) { target = parseReal(text, option, 0, 1); },
            help, kSaliencyGroup);
    };
    share("--u1", u1, "share of brightness in the saliency (default 0.5)");
    share("--u2", u2, "share of saturation; both shares sum to 1, one alone determines the other");
    addValue(
        app, "--saliency-background", "R,G,B",
        [this](const std::string& text, const std::string& option) { saliency.background = parseColor(text, option); },
        "colour of voxels in no feature, components from 0 to 1 or #rrggbb (default black)", kSaliencyGroup);
}

VwsOptions SaliencyInput::vws() const {
    VwsOptions options;
    if (u1)
        options = {*u1, u2.value_or(1 - *u1)};
    else if (u2)
        options = {1 - *u2, *u2};
    if (std::abs(options.u1 + options.u2 - 1) > 1e-9)
        throw UsageError("the shares of brightness and saturation do not sum to 1", "--u1 and --u2",
                         "give two numbers that do, or one of them");
    return options;
}

} // namespace pellucid::cli
