#include "share/share.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/base64.h"
#include "base/check.h"
#include "base/round_numbers.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "render/ambient_occlusion.h"
#include "session/caption.h"
#include "session/workspace.h"
#include "share/packed_voxels.h"
#include "share/page_files.h"
#include "share/page_text.h"
#include "share/scene_block.h"
#include "tf/shown_tf.h"
#include "volume/excerpt.h"

namespace pellucid {

namespace {

constexpr int kLongestAxis = 2048; ///< of 3D textures in nearly all browsers
constexpr int kStillWidth = 800, kStillHeight = 600;
constexpr std::size_t kMostStillBytes = 130'000; ///< of the still picture; a larger one is halved
constexpr double kUsualPageBytes = 250'000;      ///< of all but the voxels
constexpr double kMegabyte = 1e6;

int bitsOf(ShareBits bits) { return bits == ShareBits::Auto ? 0 : bits == ShareBits::Eight ? 8 : 16; }

Int3 dimsAt(const Int3& full, int factor) { return planOf({Int3(0), full}, full, factor).dims; }

/// The smallest factor that keeps to the number of voxels, and to what browsers take.
int factorFor(const Int3& full, int voxels) {
    int factor = 1;
    for (;; ++factor) {
        const Int3 dims = dimsAt(full, factor);
        const bool fits = voxelCount(dims) <= static_cast<std::size_t>(voxels);
        if (fits && std::max({dims.x, dims.y, dims.z}) <= kLongestAxis) return factor;
    }
}

/// The next factor that leaves fewer voxels. Throws Error where there is none.
int coarserThan(const Int3& full, int factor, double megabytes) {
    const Int3 dims = dimsAt(full, factor);
    if (voxelCount(dims) == 1)
        throw Error("no page is as small as " + plainText(megabytes) + " MB", "",
                    "allow more: a page without its voxels takes about " + plainText(kUsualPageBytes / kMegabyte) +
                        " MB");
    while (dimsAt(full, factor) == dims) ++factor;
    return factor;
}

// ---------------------------------------------------------------------------------------------- what is in the page

/// The volume as the page has it.
struct Voxels {
    std::shared_ptr<const Volume> volume;
    ShareCodes codes;
    std::vector<unsigned char> packed;
};

Voxels voxelsAt(const Scene& scene, int factor, int bits, const std::vector<std::uint8_t>& openness,
                const JobControl& job) {
    Voxels voxels;
    voxels.volume = factor == 1 ? scene.volume : std::make_shared<const Volume>(coarserCopy(*scene.volume, factor));
    voxels.codes = shareCodes(*voxels.volume, bits);
    std::vector<unsigned char> planes = voxelPlanes(*voxels.volume, voxels.codes, {job.stop, {}});
    planes.insert(planes.end(), openness.begin(), openness.end());
    voxels.packed = deflated(planes, job);
    return voxels;
}

ShareFigures figuresOf(const Scene& scene, bool density, const JobControl& job) {
    ShareFigures figures;
    if (scene.tf.features.empty()) return figures;
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    workspace.weights(input, job.part(0, 2));
    figures.features = workspace.measure(input, {job.stop, {}}).features;
    if (density && input.settings.profile == Profile::Default)
        figures.curve = workspace.densityCurve(input, limitsOf(scene.tf, *scene.session.goals), {job.stop, {}});
    if (figures.curve && figures.curve->isPoint()) figures.curve.reset();
    job.report(1);
    return figures;
}

Image halved(const Image& image) {
    Image half(image.width / 2, image.height / 2);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            for (int c = 0; c < 4; ++c)
                half.pixel(x, y)[c] = 0.25f * (image.pixel(2 * x, 2 * y)[c] + image.pixel(2 * x + 1, 2 * y)[c] +
                                               image.pixel(2 * x, 2 * y + 1)[c] + image.pixel(2 * x + 1, 2 * y + 1)[c]);
    return half;
}

/// What browsers show that draw no volume, and others until the voxels are there.
std::vector<unsigned char> stillOf(const ShareTask& task, const JobControl& job) {
    RenderSettings settings = task.look;
    settings.width = kStillWidth;
    settings.height = kStillHeight;
    settings.ground.reset();
    settings.overlay.reset();
    const auto renderer = makeRenderer(task.scene.session.measure->engine, task.scene.volume);
    Image image = renderer->render(task.scene.camera, shownTf(task.scene.tf), settings, job);
    std::vector<unsigned char> png = pngOf(image);
    while (png.size() > kMostStillBytes && image.width > 100) {
        image = halved(image);
        png = pngOf(image);
    }
    return png;
}

// ---------------------------------------------------------------------------------------------- the page's words

std::string timesText(const Int3& n) {
    return std::to_string(n.x) + " &times; " + std::to_string(n.y) + " &times; " + std::to_string(n.z);
}

std::string sizeText(const Voxels& voxels, const Int3& full, int factor) {
    std::string text = timesText(voxels.volume->dims()) + " voxels";
    if (factor > 1)
        text += ", made coarser: each is the mean of up to " + timesText(glm::min(Int3(factor), full)) + " of " +
                timesText(full);
    return text;
}

std::string contentsText(const Voxels& voxels) {
    const std::string levels = std::to_string(voxels.codes.maxCode + 1);
    return "The voxels are in this file: whoever has it has the data. Each has " +
           (voxels.codes.exact ? std::string("its own value within the intensity window.")
                               : "one of " + levels + " levels of the intensity window.") +
           " Shares are figures of the whole volume, by Pellucid, and do not follow what is changed here.";
}

std::string backgroundText(const RenderSettings& look) {
    const std::string bottom = hexFromRgb(*look.background);
    return look.backgroundTop ? "linear-gradient(to top, " + bottom + ", " + hexFromRgb(*look.backgroundTop) + ")"
                              : bottom;
}

const std::string& fileNamed(const std::vector<PageFile>& files, const std::string& name) {
    const auto file = std::find_if(files.begin(), files.end(), [&](const PageFile& f) { return f.name == name; });
    PELLUCID_CHECK(file != files.end());
    return file->text;
}

std::string shaderText() {
    std::string text = webShader(fileNamed(rayShaders(), "opacity.glsl")) + fileNamed(pageFiles(), "volume.glsl");
    for (const char* name : {"brick", "picture_ray", "leap", "light", "tf_segment", "emission_ray"}) {
        const std::string part = webShader(fileNamed(rayShaders(), std::string(name) + ".glsl"));
        text += std::string(name) == "light" ? "#ifdef LIGHT\n" + part + "#endif\n" : part;
    }
    return text + fileNamed(pageFiles(), "ray.frag");
}

std::string scriptText() {
    std::string text = "\"use strict\";\n";
    for (const char* name : {"unpack", "tables", "camera", "blocks", "raycaster", "viewer", "hand", "panel", "main"})
        text += fileNamed(pageFiles(), std::string(name) + ".js");
    return text;
}

struct PageParts {
    std::string title, still;
    const Scene& scene;
    const RenderSettings& look;
    const ShareFigures& figures;
    std::optional<Int3> openness;
};

/// Of the saved view, as far as it has been measured. A frame may be named after its file, and so is left out where it
/// has no time.
CaptionFacts factsOf(const PageParts& parts) {
    Measures measures;
    measures.features = parts.figures.features;
    CaptionFacts facts = captionFacts(parts.scene, measures);
    facts.title = parts.title;
    facts.lit = parts.look.light.on;
    if (!parts.scene.series || !parts.scene.series->listing().hasTimes) facts.frame.clear();
    return facts;
}

std::string pageText(const PageParts& parts, const Voxels& voxels, int factor) {
    return filled(fileNamed(pageFiles(), "page.html"), [&](const std::string& name) -> std::string {
        if (name == "title") return htmlText(parts.title);
        if (name == "alt") return htmlText(altText(factsOf(parts)));
        if (name == "caption") return htmlText(caption(factsOf(parts)));
        if (name == "version") return PELLUCID_VERSION;
        if (name == "style") return fileNamed(pageFiles(), "page.css");
        if (name == "background") return backgroundText(parts.look);
        if (name == "still") return parts.still;
        if (name == "size") return sizeText(voxels, parts.scene.volume->dims(), factor);
        if (name == "contents") return contentsText(voxels);
        if (name == "voxels") return digitsOf(voxels.packed);
        if (name == "shader") return shaderText();
        if (name == "script") return scriptText();
        PELLUCID_CHECK(name == "scene");
        return scriptJson(jsonOf(SceneBlock{parts.title, parts.scene, parts.look, *voxels.volume, factor, voxels.codes,
                                            voxels.packed.size(), parts.openness, parts.figures}));
    });
}

std::vector<std::string> leftOutOf(const ShareTask& task, const ShareFigures& figures) {
    std::vector<std::string> left;
    if (task.look.ground) left.emplace_back("the ground is not in the page");
    if (task.look.overlay) left.emplace_back("the overlay is not in the page");
    if (task.look.light.occlusion > 0)
        left.emplace_back("ambient occlusion stays that of the saved view when features are hidden or shown");
    if (task.settings.density == ShareDensity::On && !figures.curve)
        left.emplace_back("there is no density slider: no other picture has these shares");
    return left;
}

} // namespace

template <>
std::span<const Setting> settingsOf<ShareSettings>() {
    using S = ShareSettings;
    static constexpr const char* kBits[] = {"As the data need", "8 bits", "16 bits"};
    static constexpr const char* kDensity[] = {"With the slider", "Without"};
    static const Setting kSettings[] = {
        {.key = "voxels",
         .at = member<&S::voxels>,
         .words = "&Voxels",
         .help = "The most voxels that the page holds; a larger volume is made coarser.",
         .range = {1, 2e9}},
        {.key = "mb",
         .at = member<&S::megabytes>,
         .words = "&Megabytes",
         .help = "The largest size of the file in millions of bytes; a volume that takes more is made coarser.",
         .range = {0, NumberRange::kFinite, NumberRange::Open::Low}},
        {.key = "bits",
         .at = member<&S::bits>,
         .words = "&Bits",
         .help = "Bits of an intensity; auto takes 8 where they hold every value, else 16.",
         .choices = kBits},
        {.key = "title",
         .at = member<&S::title>,
         .words = "&Title",
         .help = "The title of the page; without one it is the name of the file, and of DICOM data just Volume."},
        {.key = "density",
         .at = member<&S::density>,
         .words = "&Density",
         .help = "Whether the page has a slider for the density at equal shares.",
         .choices = kDensity,
         .option = "density-slider"},
    };
    return kSettings;
}

std::string proposedTitle(const Scene& scene) {
    const std::string& format = scene.data->format;
    const std::string usual = "Volume";
    if (format == "DICOM" || format == "derived") return usual;
    std::string name = scene.data->title;
    name = name.substr(name.find_last_of("/\\") + 1);
    name = name.substr(0, name.find('.'));
    return name.empty() ? usual : name;
}

double pageBytesPerVoxel(const Scene& scene, ShareBits bits) {
    const ShareCodes codes = shareCodes(*scene.volume, bitsOf(bits));
    return packedBytesPerVoxel(*scene.volume, codes) * static_cast<double>(digitCount(1'300'000)) / 1.3e6;
}

ShareEstimate estimateShare(const Scene& scene, const ShareSettings& settings, double perVoxel) {
    const Int3& full = scene.volume->dims();
    const ShareCodes codes = shareCodes(*scene.volume, bitsOf(settings.bits));
    const auto bytesAt = [&](int factor) {
        return kUsualPageBytes + perVoxel * static_cast<double>(voxelCount(dimsAt(full, factor)));
    };
    int factor = factorFor(full, settings.voxels);
    while (settings.megabytes && bytesAt(factor) > *settings.megabytes * kMegabyte &&
           voxelCount(dimsAt(full, factor)) > 1)
        factor = coarserThan(full, factor, *settings.megabytes);
    return {dimsAt(full, factor), factor, codes.bits, bytesAt(factor)};
}

void checkShare(const ShareTask& task) {
    const std::string where = task.scene.volume->title;
    if (!task.look.background) throw UsageError("a page has no transparent background", "", "give a colour");
    if (task.scene.session.field->kind)
        throw Error("a page shows the data, and a field is shown in their place", where, "switch the field off");
    if (task.look.colors)
        throw Error("a page draws the colours of the transfer function, and here they come from several variables",
                    where, "choose a single variable for the colours");
    if (task.look.mode != RenderMode::Composite)
        throw Error("a page draws by emission and absorption alone", where, "choose the mode composite");
    task.look.validate();
}

SharedPage makeShare(const ShareTask& task, const JobControl& job) {
    checkShare(task);
    const Scene& scene = task.scene;
    const Int3& full = scene.volume->dims();
    const ShareFigures figures = figuresOf(scene, task.settings.density == ShareDensity::On, job.part(0, 3));
    const std::string title = task.settings.title.empty() ? proposedTitle(scene) : task.settings.title;
    PageParts parts{title, base64(stillOf(task, job.part(1, 3))), scene, task.look, figures, {}};
    std::vector<std::uint8_t> openness;
    if (task.look.light.occlusion > 0) {
        const Grid<std::uint8_t> open =
            makeAmbientOcclusion(*sharedIntensityGrid(*scene.volume), scene.volume->geometry(), shownTf(scene.tf),
                                 task.look.featureAlone(scene.tf))
                .open;
        parts.openness = open.dims();
        openness.assign(open.data(), open.data() + voxelCount(open.dims()));
    }

    const std::optional<double> most = task.settings.megabytes;
    for (int factor = factorFor(full, task.settings.voxels);; factor = coarserThan(full, factor, *most)) {
        const Voxels voxels = voxelsAt(scene, factor, bitsOf(task.settings.bits), openness, job.part(2, 3));
        if (most && static_cast<double>(digitCount(voxels.packed.size())) > *most * kMegabyte) continue;
        const std::string page = pageText(parts, voxels, factor);
        if (most && static_cast<double>(page.size()) > *most * kMegabyte) continue;
        job.throwIfStopped();
        writeTextAtomically(task.path, page);
        job.report(1);
        return {page.size(),       voxels.packed.size(),        voxels.volume->dims(),     factor,
                voxels.codes.bits, voxels.codes.largestError(), figures.curve.has_value(), leftOutOf(task, figures)};
    }
}

} // namespace pellucid
