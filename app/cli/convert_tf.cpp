#include "convert_tf.h"

#include "base/atomic_file.h"
#include "base/text.h"
#include "parse.h"
#include "session/scene_data.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_snippets.h"
#include "tf_notices.h"

namespace pellucid::cli {

namespace {

constexpr const char* kPython = "-python";

/// What a transfer function is written as: a file of a program, or lines for its console.
struct Target {
    const TfFormat* format = nullptr;
    const TfSnippet* snippet = nullptr;

    std::string name() const { return format != nullptr ? format->name : snippet->name + std::string(kPython); }
    std::string inWords() const {
        return format != nullptr ? format->inWords : std::string("lines of Python for ") + snippet->console;
    }
    std::string suffix() const { return format != nullptr ? format->suffix : ".py"; }
    WrittenTf write(const TfToWrite& tf) const {
        return format != nullptr ? writtenTf(*format, tf) : writtenTf(*snippet, tf);
    }
};

std::string pythonNames(const char* between) {
    return joined(tfSnippets(), between, [](const TfSnippet& s) { return s.name + std::string(kPython); });
}

Target targetNamed(const std::string& name) {
    for (const TfSnippet& snippet : tfSnippets())
        if (lowerCase(name) == snippet.name + std::string(kPython)) return {nullptr, &snippet};
    try {
        return {&tfFormatNamed(name), nullptr};
    } catch (const UsageError& error) { // which knows of files alone
        throw UsageError(error.problem(), error.where(),
                         error.whatToDo() + ", or for lines of Python " + pythonNames(", "));
    }
}

/// A transfer function, with what it is written for and what is to be said of it.
struct TfSource {
    TfToWrite writing;
    std::vector<std::string> notices;
};

/// Opacities as the program that wrote the file draws them, whatever they are opened as.
TransferFunction asWritten(const ReadTf& read, const Geometry& geometry) {
    return withOpacitiesPer(read.tf, geometry.d0() / read.length.inWorld(geometry));
}

TfSource sourceOf(const TfConversion& conversion, const SceneOptions& options, const std::string& out,
                  Progress& progress) {
    const std::string spec = *options.volume.path;
    const bool isAutomatic = spec == kAutomaticTf;
    std::vector<std::string> notices;
    std::optional<ReadTf> read;
    if (!isAutomatic) {
        read = readTfNamed(spec);
        notices = read->notices;
    }
    if (!conversion.volume) {
        if (isAutomatic) throw UsageError("what the data propose needs data", "TF auto", "add --volume FILE");
        if (read->positions) notices.push_back(noDomainNotice(*read->positions, {}));
        return {{asWritten(*read, unknownVolume()), {}, {}, presetNameOf(out)}, std::move(notices)};
    }
    SceneOptions ofVolume = options;
    ofVolume.volume.path = conversion.volume;
    if (isAutomatic) ofVolume.tf.spec = spec;
    const Opened opened = resolve(ofVolume, progress, {.use = {}, .byEngine = false, .needsTf = isAutomatic});
    const Scene& scene = opened.scene;
    const ValueRange window = read && read->spansData ? dataRangeOf(scene) : scene.volume->range();
    if (read && read->positions) notices.push_back(noDomainNotice(*read->positions, window));
    addTo(notices, opened.notices());
    const TransferFunction tf = read ? asWritten(*read, scene.volume->geometry()) : scene.tf;
    return {toWrite(tf, scene, out, window), std::move(notices)};
}

} // namespace

std::string tfFormatNames() {
    return joined(tfFormats(), " ", &TfFormat::name) + "; or as lines of Python: " + pythonNames(" ");
}

Answer convertTf(const TfConversion& conversion, const SceneOptions& options, const std::string& out,
                 Progress& progress) {
    if (!options.volume.path) throw UsageError("no transfer function is named", "TF", "give a file, such as a.tf.json");
    const Target target = atOption("--to " + conversion.format, [&] { return targetNamed(conversion.format); });
    const auto [writing, said] = sourceOf(conversion, options, out, progress);
    const WrittenTf written = target.write(writing);
    writeTextAtomically(out, written.text);
    std::vector<std::string> losses = said;
    addTo(losses, written.losses);
    Json json{{"command", "convert"},
              {"file", out},
              {"to", target.name()},
              {"points", writing.tf().points.size()},
              {"reference_length", writing.geometry().d0()},
              {"losses", losses}};
    if (writing.hasRange()) json["range"] = {writing.range().lo, writing.range().hi};
    std::vector<std::string> notices = std::move(losses);
    if (!lowerCase(out).ends_with(target.suffix()))
        notices.push_back("the name of " + target.inWords() + " should end in " + target.suffix());
    return {"wrote " + out + ": " + target.inWords() + "\n", std::move(json), std::move(notices)};
}

} // namespace pellucid::cli
