#include "study/preparation.h"

#include <algorithm>
#include <filesystem>
#include <variant>

#include "base/atomic_file.h"
#include "base/text.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "render/feature_pictures.h"
#include "render/memory_needs.h"
#include "render/view_text.h"
#include "session/session_json.h"
#include "session/workspace.h"
#include "study/answers.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

using Picture = std::vector<unsigned char>; ///< the bytes of a PNG file

/// What `work()` returns; of its errors, the place begins with the stimulus.
template <class Work>
auto ofStimulus(const Stimulus& stimulus, const Work& work) {
    try {
        return work();
    } catch (const Error& e) {
        const std::string where = "stimulus " + stimulus.id + (e.where().empty() ? "" : ", " + e.where());
        throw Error(e.problem(), where, e.whatToDo(), e.remedy());
    }
}

MemoryUse usedBy(const MeasureSettings& settings) {
    if (settings.profile == Profile::Published) return byPublished(toMeasureAndDrawField());
    return settings.engine == EngineChoice::Reference ? byReference(toMeasureAndDrawField()) : toMeasureAndDrawField();
}

SceneInputs inputsOf(const Study& study, const Stimulus& stimulus, std::optional<EngineChoice> engine,
                     std::vector<std::string>& notices) {
    SceneInputs inputs;
    if (!stimulus.session.empty()) {
        SessionFile file = readSession(stimulus.session);
        inputs.session = std::move(file.session);
        for (const std::string& notice : file.notices) notices.push_back("stimulus " + stimulus.id + ": " + notice);
    } else {
        VolumeSource source;
        source.path = stimulus.volume;
        inputs.session = sessionOf(source);
    }
    if (!stimulus.tf.empty()) inputs.tf = stimulus.tf;
    if (!stimulus.view.empty()) {
        const WordedView view = viewFromText(stimulus.view);
        if (const auto* angles = std::get_if<ViewAngles>(&view)) inputs.view = *angles;
        if (const auto* named = std::get_if<NamedView>(&view)) inputs.namedView = *named;
    }
    if (engine) inputs.session.measure.edit([&](MeasureSettings& m) { m.engine = *engine; });
    inputs.session.display.edit([&](DisplaySettings& d) {
        d.background = study.background;
        d.backgroundTop.reset();
    });
    inputs.then = usedBy(*inputs.session.measure);
    return inputs;
}

std::size_t featureOf(const Scene& scene, const std::string& name) {
    const std::vector<Feature>& features = scene.tf.features;
    const auto at = std::ranges::find(features, name, &Feature::name);
    if (at == features.end())
        throw Error("there is no feature '" + name + "'", "",
                    features.empty() ? "the transfer function has no features"
                                     : "name one of " + joined(features, ", ", &Feature::name));
    return static_cast<std::size_t>(at - features.begin());
}

/// Draws and measures one stimulus, into its figures.
Picture prepare(const Study& study, Stimulus& stimulus, const SceneInputs& inputs, const JobControl& job) {
    const Scene scene = openScene(inputs, job.part(0, 4));
    const std::size_t feature = featureOf(scene, stimulus.feature);
    Workspace workspace;
    const MeasureInput input = measureInput(scene);
    const FeatureMeasures figures = workspace.measure(input, job.part(1, 4)).features[feature];
    stimulus.vws = figures.vws;
    stimulus.visibility = figures.visibility;
    stimulus.engine = workspace.engine(input).name();
    stimulus.data = scene.volume->title;
    stimulus.color = scene.tf.features[feature].color;
    workspace.releaseEngine();
    const PictureInput picture = pictureInput(scene, study.width, study.height);
    const auto renderer = makeRenderer(scene.session.measure->engine, picture.volume);
    const FeaturePictures pictures =
        featurePictures(*renderer, picture.camera, picture.tf, picture.settings, job.part(2, 4));
    stimulus.fs = featureSaliency(pictures, job.part(3, 4)).shares[feature];
    return pngOf(pictures.whole);
}

void makeFolder(const std::string& folder) {
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (ec && !fs::is_directory(folder))
        throw FileError("cannot create the folder (" + ec.message() + ")", folder, "check permissions and space");
}

} // namespace

void requireNoAnswers(const std::string& folder) {
    const std::vector<Participant> participants = readParticipants(folder);
    const auto count = std::ranges::count_if(participants, [](const Participant& p) { return !p.answers.empty(); });
    if (count > 0)
        throw Error("the folder has the answers of " + std::to_string(count) +
                        (count == 1 ? " participant" : " participants") + " to the pictures that are there",
                    participantsFolder(folder), "choose another folder");
}

PreparedStudy prepareStudy(const Study& study, const std::string& folder, std::optional<EngineChoice> engine,
                           const JobControl& job) {
    if (study.stimuli.empty()) throw Error("the study has no stimuli", study.title, "add some first");
    requireNoAnswers(folder);
    PreparedStudy prepared{study, {}};
    std::vector<SceneInputs> inputs; // first all that is small: an error in it should not wait for pictures
    for (const Stimulus& s : study.stimuli)
        inputs.push_back(ofStimulus(s, [&] { return inputsOf(study, s, engine, prepared.notices); }));
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        Stimulus& s = prepared.study.stimuli[i];
        const JobControl part = job.part(i, inputs.size());
        pictures.push_back(ofStimulus(s, [&] { return prepare(study, s, inputs[i], part); }));
        s.picture = (fs::path(picturesFolder(folder)) / (s.id + ".png")).string();
    }
    makeFolder(picturesFolder(folder));
    std::error_code ec; // until the new figures are there, those of an older study are not those of the pictures
    fs::remove(preparedStudyFile(folder), ec);
    for (std::size_t i = 0; i < pictures.size(); ++i)
        writeBytesAtomically(prepared.study.stimuli[i].picture, pictures[i]);
    writeStudy(prepared.study, preparedStudyFile(folder));
    return prepared;
}

} // namespace pellucid
