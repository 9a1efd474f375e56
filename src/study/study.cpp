#include "study/study.h"

#include <algorithm>
#include <climits>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/json_file.h"
#include "base/json_value.h"
#include "base/stored_path.h"
#include "base/text.h"
#include "render/render_settings.h"
#include "session/scene.h"

namespace pellucid {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kFormat = "pellucid-study";
constexpr int kVersion = 1;
constexpr double kMostSeconds = 3600;
constexpr const char* kFeatureMark = "{feature}";

/// Whether a transfer function is named by a word of its own, not by a file.
bool isTfWord(const std::string& tf) {
    return tf == kAutomaticTf || tf.starts_with("tents:") || tf.starts_with("ramp:") || tf.starts_with("preset:");
}
bool isSample(const std::string& volume) { return volume.starts_with("sample:"); }

std::string textAt(const JsonValue& object, const char* key) {
    return object.has(key) ? object[key].text() : std::string();
}
std::string fileAt(const JsonValue& object, const char* key, const std::string& folder,
                   bool (*isWord)(const std::string&)) {
    const std::string stored = textAt(object, key);
    return stored.empty() || isWord(stored) ? stored : foundPath(stored, folder);
}
bool isNeverWord(const std::string&) { return false; }

/// A figure that nobody knows is missing or null.
std::optional<double> figureAt(const JsonValue& object, const char* key) {
    if (!object.has(key) || object[key].json().is_null()) return {};
    return object[key].number();
}

constexpr std::initializer_list<const char*> kStimulusKeys{"id",         "session", "volume",   "tf",      "view",
                                                           "feature",    "label",   "training", "picture", "vws",
                                                           "visibility", "fs",      "engine",   "data",    "color"};

Stimulus stimulusFrom(const JsonValue& j, const std::string& folder) {
    Stimulus s;
    s.id = j["id"].text();
    if (!isStudyId(s.id))
        j["id"].fail("'" + s.id + "' cannot name a stimulus", "use up to 40 letters, digits, - and _");
    s.session = fileAt(j, "session", folder, isNeverWord);
    s.volume = fileAt(j, "volume", folder, isSample);
    if (s.session.empty() == s.volume.empty())
        j.fail("a stimulus has either a session or a volume", "give one of the two");
    s.tf = fileAt(j, "tf", folder, isTfWord);
    s.view = textAt(j, "view");
    s.feature = j["feature"].text();
    if (s.feature.empty()) j["feature"].fail("the feature has no name");
    s.label = textAt(j, "label");
    s.training = j.has("training") && j["training"].boolean();
    s.picture = fileAt(j, "picture", folder, isNeverWord);
    s.vws = figureAt(j, "vws");
    s.visibility = figureAt(j, "visibility");
    s.fs = figureAt(j, "fs");
    s.engine = textAt(j, "engine");
    s.data = textAt(j, "data");
    if (j.has("color")) s.color = j["color"].color();
    s.extraJson = j.unknownKeys(kStimulusKeys);
    return s;
}

json fromStimulus(const Stimulus& s, const std::string& folder) {
    json j{{"id", s.id}, {"feature", s.feature}};
    const auto putFile = [&](const char* key, const std::string& file, bool isWord) {
        if (!file.empty()) j[key] = isWord ? file : relativeTo(folder, file);
    };
    putFile("session", s.session, false);
    putFile("volume", s.volume, isSample(s.volume));
    putFile("tf", s.tf, isTfWord(s.tf));
    putFile("picture", s.picture, false);
    if (!s.view.empty()) j["view"] = s.view;
    if (!s.label.empty()) j["label"] = s.label;
    if (s.training) j["training"] = true;
    if (s.vws) j["vws"] = *s.vws;
    if (s.visibility) j["visibility"] = *s.visibility;
    if (s.fs) j["fs"] = *s.fs;
    if (!s.engine.empty()) j["engine"] = s.engine;
    if (!s.data.empty()) j["data"] = s.data;
    if (s.color) j["color"] = jsonFromColor(*s.color);
    addUnknownKeys(j, s.extraJson);
    return j;
}

std::map<int, std::string> labelsFrom(const JsonValue& j) {
    j.requireObject();
    std::map<int, std::string> labels;
    for (const auto& [key, value] : j.json().items()) {
        std::int64_t score = 0;
        if (!parseNumber(key, score) || score < kLowestScore || score > kHighestScore)
            j.fail("'" + key + "' is no score", "give labels to scores from 1 to 5");
        labels[static_cast<int>(score)] = j[key.c_str()].text();
    }
    return labels;
}

void requireOwnIds(const JsonValue& stimuli, const Study& study) {
    std::set<std::string> ids; // of files, which some systems do not tell apart by case
    for (std::size_t i = 0; i < study.stimuli.size(); ++i)
        if (!ids.insert(lowerCase(study.stimuli[i].id)).second)
            stimuli.items()[i]["id"].fail("another stimulus has the id '" + study.stimuli[i].id + "', too");
}

void requireRepeatable(const JsonValue& document, const Study& study) {
    const int most = study.countOfTrials() > 1 ? study.countOfTrials() : 0; // of a single one, both would be neighbours
    if (study.repeats > most)
        document["repeats"].fail("only " + std::to_string(most) + " stimuli can be shown a second time",
                                 "give a smaller number, or more stimuli that are not for training");
}

Study studyFrom(const JsonValue& document, const std::string& folder) {
    requireFormat(document, kFormat, kVersion, "give a study, *.study.json");
    Study study;
    takeSettings(document, study);
    if (document.has("labels")) study.labels = labelsFrom(document["labels"]);
    if (document.has("size")) {
        const auto sides = document["size"].items(2);
        study.width = sides[0].whole(kSmallestPicture, kMostPixels);
        study.height = sides[1].whole(kSmallestPicture, kMostPixels);
    }
    const JsonValue stimuli = document["stimuli"];
    for (const JsonValue& j : stimuli.items()) study.stimuli.push_back(stimulusFrom(j, folder));
    requireOwnIds(stimuli, study);
    requireRepeatable(document, study);
    std::vector<const char*> known{"format", "version", "labels", "size", "stimuli"};
    for (const Setting& setting : settingsOf<Study>()) known.push_back(setting.key);
    study.extraJson = document.unknownKeys(known);
    return study;
}

std::string folderOf(const std::string& path) { return fs::path(path).parent_path().string(); }

} // namespace

template <>
std::span<const Setting> settingsOf<Study>() {
    using Open = NumberRange::Open;
    static const Setting kSettings[] = {
        {.key = "title", .at = member<&Study::title>, .words = "&Title", .help = "What the study is called."},
        {.key = "consent",
         .at = member<&Study::consent>,
         .words = "&Consent",
         .help = "What participants agree to before anything else."},
        {.key = "instructions",
         .at = member<&Study::instructions>,
         .words = "&Instructions",
         .help = "What participants are told before the first trial."},
        {.key = "question",
         .at = member<&Study::question>,
         .words = "&Question",
         .help = "What is asked about each picture; {feature} becomes the word for the feature."},
        {.key = "task_seconds",
         .at = member<&Study::taskSeconds>,
         .words = "Tas&k",
         .help = "How long the question is shown before the picture; 0 leaves it out.",
         .range = {0, kMostSeconds},
         .unit = "s"},
        {.key = "image_seconds",
         .at = member<&Study::imageSeconds>,
         .words = "&Picture",
         .help = "How long the picture is shown.",
         .range = {0, kMostSeconds, Open::Low},
         .unit = "s"},
        {.key = "repeats",
         .at = member<&Study::repeats>,
         .words = "&Repeats",
         .help = "How many of the stimuli are shown a second time, to see how consistent answers are.",
         .range = {0, 100000}},
        {.key = "pause_every",
         .at = member<&Study::pauseEvery>,
         .words = "P&ause after",
         .help = "After how many trials participants may rest; 0 for no pauses.",
         .range = {0, 100000},
         .unit = "trials"},
        {.key = "seed",
         .at = member<&Study::seed>,
         .words = "&Seed",
         .help = "What the order of trials is drawn from, together with the participant.",
         .range = {0, INT_MAX}},
        {.key = "background",
         .at = member<&Study::background>,
         .words = "&Background",
         .help = "The colour behind the pictures and around them."},
    };
    return kSettings;
}

const Stimulus* Study::find(const std::string& id) const {
    const auto at = std::ranges::find(stimuli, id, &Stimulus::id);
    return at == stimuli.end() ? nullptr : &*at;
}

std::string Study::questionOf(const Stimulus& stimulus) const {
    std::string text = question;
    if (const std::size_t at = text.find(kFeatureMark); at != std::string::npos)
        text.replace(at, std::string(kFeatureMark).size(), stimulus.word());
    return text;
}

int Study::countOfTrials() const { return static_cast<int>(std::ranges::count(stimuli, false, &Stimulus::training)); }

bool isStudyId(const std::string& text) {
    const auto isLetterOrDigit = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    return !text.empty() && text.size() <= 40 && isLetterOrDigit(text.front()) &&
           std::ranges::all_of(text, [&](char c) { return isLetterOrDigit(c) || c == '-' || c == '_'; });
}

std::string freeStimulusId(const Study& study) {
    for (std::size_t n = study.stimuli.size() + 1;; ++n) {
        const std::string id = (n < 10 ? "s0" : "s") + std::to_string(n);
        if (study.find(id) == nullptr) return id;
    }
}

Study readStudy(const std::string& path) {
    const json document = readJson(path);
    return studyFrom({document, path}, folderOf(path));
}

namespace {

json documentOf(const Study& study, const std::string& folder) {
    json j{{"format", kFormat}, {"version", kVersion}, {"size", {study.width, study.height}}};
    putSettings(j, study);
    j["labels"] = json::object();
    for (const auto& [score, label] : study.labels) j["labels"][std::to_string(score)] = label;
    j["stimuli"] = json::array();
    for (const Stimulus& s : study.stimuli) j["stimuli"].push_back(fromStimulus(s, folder));
    addUnknownKeys(j, study.extraJson);
    return j;
}

} // namespace

void writeStudy(const Study& study, const std::string& path) {
    std::string text;
    try {
        text = documentOf(study, folderOf(path)).dump(2) + "\n";
    } catch (const json::type_error&) {
        throw FileError("a name in the study is not UTF-8 text, which its file is made of", path, "rename it");
    }
    writeTextAtomically(path, text);
}

Study checked(Study study, const std::string& where) {
    const json document = documentOf(study, "");
    static_cast<void>(studyFrom({document, where}, ""));
    return study;
}

Study readPreparedStudy(const std::string& folder) {
    const std::string path = preparedStudyFile(folder);
    std::error_code ec;
    if (!fs::exists(path, ec))
        throw FileError("this folder has no prepared study", folder.empty() ? "." : folder,
                        "name the folder that a study was prepared into");
    Study study = readStudy(path);
    for (std::size_t i = 0; i < study.stimuli.size(); ++i)
        if (study.stimuli[i].picture.empty())
            throw Error("the stimulus has no picture", path + " at /stimuli/" + std::to_string(i),
                        "prepare the study first");
    if (study.stimuli.empty()) throw Error("the study has no stimuli", path, "add some and prepare it again");
    return study;
}

std::string preparedStudyFile(const std::string& folder) { return (fs::path(folder) / "study.json").string(); }
std::string picturesFolder(const std::string& folder) { return (fs::path(folder) / "pictures").string(); }
std::string participantsFolder(const std::string& folder) { return (fs::path(folder) / "participants").string(); }

} // namespace pellucid
