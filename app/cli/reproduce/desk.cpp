#include "reproduce/desk.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/child_program.h"
#include "base/json_file.h"
#include "base/stopwatch.h"
#include "command_line.h"
#include "reproduce/thesis_tfs.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"

namespace pellucid::cli {

namespace {

constexpr int kInterrupted = 130; ///< exit status after Ctrl-C

Source sampleSource(const std::string& name, int size, const std::string& inPlaceOf) {
    return {{"sample:" + name, "--sample-size", std::to_string(size)},
            "sample:" + name + ", " + std::to_string(size) + " voxels long" +
                (inPlaceOf.empty() ? "" : ", in place of " + inPlaceOf)};
}

/// The last line of what a command said, without the words that every error begins with.
std::string reasonOf(const ChildEnd& end) {
    std::string line = end.error.substr(end.error.rfind('\n') + 1);
    if (const std::string begin = "pellucid-cli: error: "; line.starts_with(begin)) line.erase(0, begin.size());
    return line.empty() ? "exit status " + std::to_string(end.status) : line;
}

} // namespace

std::optional<std::filesystem::path> realFileOf(const DataNeed& need, const DeskSettings& settings) {
    if (!settings.data || need.real.empty()) return {};
    const std::filesystem::path file = *settings.data / need.real;
    std::error_code ec;
    if (!std::filesystem::exists(file, ec)) return {};
    return file;
}

Source sourceOf(const DataNeed& need, const DeskSettings& settings) {
    if (!realFileOf(need, settings)) return sampleSource(need.sample, settings.sampleSize, need.thesis);
    return {{std::string(kDataLink) + "/" + need.real},
            need.real + (need.isTheSame ? ", the " + need.thesis + " of the thesis" : ", in place of " + need.thesis),
            true,
            need.isTheSame};
}

std::vector<FeatureFigures> featuresOf(const Json& measured) {
    std::vector<FeatureFigures> features;
    for (const Json& f : measured.at("features"))
        features.push_back({f.at("name"), f.at("opacity"), f.at("visibility"), f.at("vws"), f.at("vws_brightness"),
                            f.at("vws_saturation"), f.at("cover"), f.value("fs", 0.0)});
    return features;
}

Desk::Desk(const Item& item, const DeskSettings& settings, std::stop_token stop)
    : m_settings(settings), m_stop(std::move(stop)), m_needs(item.data), m_result(item.unmade()) {
    std::error_code ec;
    std::filesystem::create_directories(settings.folder / item.id(), ec);
    if (ec)
        throw FileError("cannot create the folder (" + ec.message() + ")", (settings.folder / item.id()).string(),
                        "check permissions and space");
}

Source Desk::used(Source source) {
    if (std::ranges::find(m_result.data, source.said) == m_result.data.end()) m_result.data.push_back(source.said);
    return source;
}

Source Desk::data(std::size_t need) { return used(sourceOf(m_needs.at(need), m_settings)); }

Source Desk::sample(const std::string& name, int size, const std::string& inPlaceOf) {
    return used(sampleSource(name, size, inPlaceOf));
}

std::string Desk::tf(const std::string& name) {
    const std::string fileName = name + ".tf.json";
    const auto found = std::ranges::find_if(thesisTfs(), [&](const ThesisTf& tf) { return tf.name == fileName; });
    PELLUCID_CHECK(found != thesisTfs().end());
    writeTextAtomically(pathOf(file(fileName)).string(), found->text);
    return file(fileName);
}

std::string Desk::writeTf(const std::string& name, const TransferFunction& tf) {
    pellucid::writeTf(tf, pathOf(file(name + ".tf.json")).string());
    return file(name + ".tf.json");
}

TransferFunction Desk::readTf(const std::string& file) const { return pellucid::readTf(pathOf(file).string()); }

std::string Desk::start(const Words& words, const std::string& out) {
    Words all = words;
    for (const auto& [option, value] : m_settings.common)
        if (std::ranges::find(words, option) == words.end()) all = all + Words{option, value};
    const std::string line = commandLineOf(all) + (out.empty() ? "" : " > " + out);
    const Stopwatch watch;
    const ChildEnd end = runChild({m_settings.program, all, m_settings.folder, out.empty() ? "" : pathOf(out)}, m_stop);
    m_result.commands.push_back({line, watch.seconds()});
    if (end.status == kInterrupted) throw Cancelled{}; // the terminal has told it before us
    if (end.status != 0)
        throw Error("a command failed: " + reasonOf(end), line, "run it in " + m_settings.folder.string());
    return line;
}

void Desk::run(const Words& words) { start(words, ""); }

Json Desk::ask(const std::string& name, const Words& words) {
    const std::string answer = file(name + ".json");
    start(words + Words{"--json"}, answer);
    return readJson(pathOf(answer).string());
}

void Desk::render(const std::string& name, const std::string& figure, const std::string& caption, const Words& words) {
    run(Words{"render"} + words + Words{"--size", kPictureSize, "--out", file(name)});
    picture(file(name), figure, caption);
}

void Desk::picture(const std::string& file, const std::string& figure, const std::string& caption) {
    m_result.pictures.push_back({file, figure, caption});
}

void Desk::number(const std::string& what, double ours, double thesis, const std::string& unit) {
    m_result.numbers.push_back({what, ours, thesis, unit});
}

void Desk::statement(const std::string& section, const std::string& sentence, bool holds, const std::string& figures,
                     const std::string& otherwise) {
    m_result.statements.push_back({sentence, section, holds, figures});
    if (!holds && !otherwise.empty()) remark(otherwise);
}

Reproduction Desk::result(double seconds) const {
    Reproduction whole = m_result;
    whole.seconds = seconds;
    return whole;
}

} // namespace pellucid::cli
