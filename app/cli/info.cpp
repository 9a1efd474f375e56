// `info`: what a volume file holds.
#include <algorithm>

#include "commands.h"
#include "resolve.h"
#include "volume/file_contents.h"
#include "volume/orientation.h"

namespace pellucid::cli {

namespace {

std::string regionText(const VoxelRegion& r) {
    std::string text;
    for (int a = 0; a < 3; ++a) text += (a > 0 ? "," : "") + std::to_string(r.lo[a]) + ":" + std::to_string(r.hi[a]);
    return text;
}

std::string textOf(const Volume& v) {
    const std::string unit = std::string(" ") + lengthUnit(v.geometry());
    std::vector<std::pair<std::string, std::string>> lines{
        {"title", v.title},
        {"format", v.format},
        {"dims", dimsText(v.dims()) + " voxels"},
        {"type", name(v.sampleType())},
        {"spacing", vectorText(v.geometry().spacing) + unit},
        {"origin", vectorText(v.geometry().origin) + unit},
        {"frame", v.geometry().worldAxes == WorldAxes::Patient ? "patient (LPS," + unit + ")" : "the file's own"},
        {"axes", axesText(v.geometry())},
        {"range", rangeText(v.range().lo, v.range().hi)},
    };
    if (v.excerpt) {
        const Excerpt& e = *v.excerpt;
        lines.emplace_back("data", dimsText(e.fullDims) + " voxels");
        lines.emplace_back("region", regionText(e.region));
        lines.emplace_back("downsampled", "by " + std::to_string(e.factor));
    }
    if (v.range() != v.dataRange()) lines.emplace_back("values", rangeText(v.dataRange().lo, v.dataRange().hi));
    lines.emplace_back("invalid", countText(v.invalidCount()) + " of " + countText(v.size()) + " voxels");
    lines.emplace_back("memory", bytesText(v.memoryBytes()));
    for (const std::string& notice : v.notices) lines.emplace_back("notice", notice);
    return listing(lines);
}

/// Where the axes i, j and k point: a unit vector each.
Json directions(const Geometry& g) {
    return {jsonFromVector(g.directions[0]), jsonFromVector(g.directions[1]), jsonFromVector(g.directions[2])};
}

Json jsonOf(const Volume& v) {
    const Excerpt whole{v.dims(), {Int3(0), v.dims()}, 1, false}, e = v.excerpt.value_or(whole);
    return {{"command", "info"},
            {"dims", jsonFromDims(v.dims())},
            {"full_dims", jsonFromDims(e.fullDims)},
            {"region", {jsonFromDims(e.region.lo), jsonFromDims(e.region.hi)}},
            {"downsample", e.factor},
            {"type", name(v.sampleType())},
            {"spacing", jsonFromVector(v.geometry().spacing)},
            {"origin", jsonFromVector(v.geometry().origin)},
            {"frame", v.geometry().worldAxes == WorldAxes::Patient ? "patient" : "file"},
            {"unit", lengthUnit(v.geometry())},
            {"directions", directions(v.geometry())},
            {"range", jsonFromRange(v.range())},
            {"data_range", jsonFromRange(v.dataRange())},
            {"invalid", v.invalidCount()},
            {"memory_bytes", v.memoryBytes()},
            {"format", v.format},
            {"title", v.title},
            {"notices", v.notices}};
}

/// What the header of the frame's file says beside; empty for samples.
FileContents contentsOfFrame(const Scene& scene) {
    const VolumeSource& source = scene.series->listing().frames[static_cast<std::size_t>(scene.session.frame)].source;
    return source.isSample() || scene.session.variable().derivation ? FileContents{} : contentsOf(source);
}

/// Frames that could not be read.
std::vector<int> brokenFrames(const TimeSeries& series) {
    std::vector<int> broken;
    for (int f = 0; f < series.size(); ++f)
        if (!series.summary(f).problem.empty()) broken.push_back(f);
    return broken;
}

/// Of the values of all frames, as far as it is known without reading.
std::optional<ValueRange> rangeOfAll(const TimeSeries& series) {
    if (series.listing().declaredRange) return series.listing().declaredRange;
    std::optional<ValueRange> range;
    for (int f = 0; f < series.size(); ++f) {
        const FrameSummary s = series.summary(f);
        if (!s.isKnown || !s.problem.empty() || s.validCount == 0) continue;
        range = range ? ValueRange{std::min(range->lo, s.range.lo), std::max(range->hi, s.range.hi)} : s.range;
    }
    return range;
}

std::string framesText(const Scene& scene) {
    const TimeSeries& series = *scene.series;
    const SeriesListing& listed = series.listing();
    std::vector<std::pair<std::string, std::string>> lines{
        {"frames", std::to_string(series.size()) + ", " + listed.label(0) + " .. " + listed.label(series.size() - 1)},
        {"this frame", std::to_string(scene.session.frame) + ", " + listed.label(scene.session.frame)},
    };
    if (listed.hasTimes) lines.emplace_back("time unit", listed.timeUnit.empty() ? "not known" : listed.timeUnit);
    if (const auto range = rangeOfAll(series)) lines.emplace_back("all frames", rangeText(range->lo, range->hi));
    for (const int f : brokenFrames(series))
        lines.emplace_back("passed over", std::to_string(f) + ", " + listed.frames[static_cast<std::size_t>(f)].name +
                                              ": " + series.summary(f).problem);
    for (const std::string& notice : listed.notices) lines.emplace_back("notice", notice);
    return listing(lines);
}

/// Each frame by name, with its time and what is known of it.
Json framesJson(const Scene& scene) {
    const TimeSeries& series = *scene.series;
    const SeriesListing& listed = series.listing();
    Json json{{"count", series.size()},
              {"frame", scene.session.frame},
              {"first", listed.label(0)},
              {"last", listed.label(series.size() - 1)}};
    if (listed.hasTimes && !listed.timeUnit.empty()) json["time_unit"] = listed.timeUnit;
    if (const auto range = rangeOfAll(series)) json["range"] = jsonFromRange(*range);
    json["broken"] = brokenFrames(series);
    Json list = Json::array();
    for (int f = 0; f < series.size(); ++f) {
        const FrameSummary summary = series.summary(f);
        Json frame{{"name", listed.frames[static_cast<std::size_t>(f)].name}};
        if (listed.hasTimes) frame["time"] = listed.frames[static_cast<std::size_t>(f)].time;
        if (!summary.problem.empty()) {
            frame["problem"] = summary.problem;
        } else if (summary.isKnown) {
            frame["valid"] = summary.validCount;
            frame["range"] = jsonFromRange(summary.range);
        }
        list.push_back(std::move(frame));
    }
    json["list"] = std::move(list);
    json["notices"] = listed.notices;
    return json;
}

} // namespace

namespace {

/// Of the arrays, each with what is said of it.
std::vector<std::string> namesOf(const FileContents& contents) {
    std::vector<std::string> names = contents.arrays;
    for (std::size_t i = 0; i < std::min(names.size(), contents.details.size()); ++i)
        names[i] += " (" + contents.details[i] + ")";
    return names;
}

} // namespace

Command addInfo(CLI::App& program) {
    CLI::App* app = program.add_subcommand("info", "What a volume holds: size, type, spacing, range, invalid voxels");
    const auto options = std::make_shared<SceneOptions>();
    options->addForData(*app);
    options->engine.addDefinitions(*app);
    return {app, [options](Progress& progress) {
                const Opened opened = resolve(*options, progress, {.use = {}, .byEngine = false, .needsTf = false});
                TimeSeries& series = *opened.scene.series;
                if (series.varies() && !series.listing().declaredRange) series.survey(progress.phase("reading frames"));
                const Volume& volume = *opened.scene.volume;
                const FileContents contents = contentsOfFrame(opened.scene);
                Answer answer{textOf(volume), jsonOf(volume), opened.sessionNotices};
                if (!contents.arrays.empty()) {
                    answer.json["arrays"] = contents.arrays;
                    if (!contents.details.empty()) answer.json["array_details"] = contents.details;
                    answer.text += listing({{"arrays", joined(namesOf(contents))}});
                }
                const Json definitions = definitionsOf(opened.scene.session);
                if (!definitions.empty()) answer.json["definitions"] = definitions;
                for (const auto& [name, words] : definitions.items())
                    answer.text += listing({{name, words.get<std::string>()}});
                if (series.varies()) {
                    answer.text += framesText(opened.scene);
                    answer.json["frames"] = framesJson(opened.scene);
                }
                return answer;
            }};
}

} // namespace pellucid::cli
