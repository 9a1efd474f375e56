#include "resolve.h"

#include <cmath>
#include <filesystem>

#include "output_files.h"
#include "render/memory_needs.h"
#include "report/session_picture.h"
#include "session/scene_data.h"
#include "tf/formats/tf_file.h"

namespace pellucid::cli {

void SceneOptions::addSession(CLI::App& app) {
    addValue(
        app, "--session", "FILE",
        [this](const std::string& text, const std::string& option) {
            if (text.empty())
                throw UsageError("the file name is empty", option,
                                 "name a session, *.pellucid.json or a PNG picture that carries one");
            sessionFile = text;
        },
        "everything as in this saved session, or in this PNG picture that carries one; VOLUME and options override it",
        "Volume");
}

void SceneOptions::addForData(CLI::App& app, VolumeOptions::SizeIs size) {
    volume.add(app, size);
    variables.add(app);
    addSession(app);
}

void SceneOptions::addForView(CLI::App& app, VolumeOptions::SizeIs size) {
    addForData(app, size);
    tf.add(app);
    camera.add(app);
    clip.add(app);
}

void SceneOptions::addForFigures(CLI::App& app, VolumeOptions::SizeIs size) {
    addForView(app, size);
    engine.add(app);
    saliency.add(app);
    engine.addProfile(app);
}

SceneInputs inputsOf(const SceneOptions& options, const Work& work, std::vector<std::string>& notices) {
    SessionFile file = options.sessionFile ? readSessionOrPicture(*options.sessionFile) : SessionFile{};
    notices.insert(notices.end(), file.notices.begin(), file.notices.end());
    SceneInputs inputs;
    inputs.session = std::move(file.session);
    options.volume.applyTo(inputs);
    options.variables.applyTo(inputs);
    options.tf.applyTo(inputs);
    options.camera.applyTo(inputs);
    options.clip.applyTo(inputs);
    options.engine.applyTo(inputs);
    options.saliency.applyTo(inputs);
    options.picture.applyTo(inputs);
    options.ground.applyTo(inputs);
    options.overlay.applyTo(inputs);
    inputs.session.coordinates.edit([&](CoordinateSettings& c) { options.coordinates.applyTo(c); });
    inputs.session.field.edit([&](FieldView& view) { options.field.applyTo(view); });
    options.engine.requireProfile(inputs, options.saliency);
    inputs.then = work.use;
    if (work.byEngine) {
        const MeasureSettings& settings = *inputs.session.measure;
        if (settings.profile == Profile::Published)
            inputs.then = byPublished(work.use);
        else if (settings.engine == EngineChoice::Reference)
            inputs.then = byReference(work.use);
        // Saliency looks 2σ far, in d0, of which no axis has more voxels.
        inputs.then.reach = static_cast<int>(std::ceil(2 * settings.saliency.sigma));
        if (const auto notice = profileNotice(settings, options.camera)) notices.push_back(*notice);
    }
    // Frames are read later, but that no output replaces one of them is known before any work.
    for (const std::string& path : filesOf(inputs.session)) addInputFile(path);
    if (inputs.session.overlay->isDrawn()) {
        const EngineChoice engine = inputs.session.measure->engine;
        if (work.byEngine)
            notices.emplace_back("figures are of the volume alone: the overlay hides nothing in them");
        else if (engine == EngineChoice::Gl || engine == EngineChoice::Slices)
            notices.emplace_back("OpenGL draws no overlay: pictures with it are drawn by the cpu engine");
    }
    if (!work.needsTf) inputs.start = SceneInputs::Start::Tents;
    return inputs;
}

std::vector<std::string> Opened::notices() const {
    std::vector<std::string> all = sessionNotices;
    const TimeSeries& series = *scene.series;
    all.insert(all.end(), series.listing().notices.begin(), series.listing().notices.end());
    constexpr int kMost = 8; // one by one
    int broken = 0;
    for (int f = 0; f < series.size() && series.varies(); ++f)
        if (const std::string problem = series.summary(f).problem; !problem.empty() && ++broken <= kMost)
            all.push_back("frame " + std::to_string(f) + " (" + series.listing().label(f) +
                          ") is passed over: " + problem);
    if (broken > kMost) all.push_back(std::to_string(broken - kMost) + " more frames are passed over");
    all.insert(all.end(), scene.volume->notices.begin(), scene.volume->notices.end());
    if (scene.overlay) all.insert(all.end(), scene.overlay->notices.begin(), scene.overlay->notices.end());
    if (scene.volume->excerpt && scene.volume->excerpt->forMemory)
        all.emplace_back("--region X0:X1,Y0:Y1,Z0:Z1 opens a part at full resolution, --downsample 1 all or nothing");
    return all;
}

namespace {

/// What is to be said of a transfer function of another program; it is read once more for that.
std::vector<std::string> tfNotices(const std::optional<std::string>& spec, const Scene& scene) {
    std::error_code failure;
    if (!spec || !std::filesystem::is_regular_file(fileOfTf(*spec), failure) || !isForeignTf(*spec)) return {};
    return openingNoticesIn(scene, readTfNamed(*spec));
}

} // namespace

Opened resolve(const SceneOptions& options, Progress& progress, const Work& work) {
    Opened opened;
    const SceneInputs inputs = inputsOf(options, work, opened.sessionNotices);
    opened.scene = openScene(inputs, progress.phase("loading"));
    options.tf.takePartsInto(opened.scene, inputs.then, progress.phase("loading"));
    options.clip.check(opened.scene);
    for (const std::string& notice : tfNotices(options.tf.spec, opened.scene)) opened.sessionNotices.push_back(notice);
    for (const std::string& notice : options.overlay.convertTf(opened.scene)) opened.sessionNotices.push_back(notice);
    if (inputs.session.clipping->rest.isNone() && opened.scene.session.clipping->rest.density > 0 &&
        !options.clip.holder)
        opened.sessionNotices.emplace_back(
            "the object lies on a board or holder, which is drawn faintly and not measured: "
            "--holder 1 draws it like the rest, --holder 0 leaves it out");
    options.tf.applyTo(opened.scene);
    options.picture.applyTo(opened.scene);
    return opened;
}

} // namespace pellucid::cli
