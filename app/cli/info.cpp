// `info`: what a volume file holds.
#include "commands.h"
#include "resolve.h"
#include "volume/orientation.h"

namespace pellucid::cli {

namespace {

std::string regionText(const VoxelRegion& r) {
    std::string text;
    for (int a = 0; a < 3; ++a) text += (a > 0 ? "," : "") + std::to_string(r.lo[a]) + ":" + std::to_string(r.hi[a]);
    return text;
}

std::string textOf(const Volume& v) {
    std::vector<std::pair<std::string, std::string>> lines{
        {"title", v.title},
        {"format", v.format},
        {"dims", dimsText(v.dims()) + " voxels"},
        {"type", name(v.sampleType())},
        {"spacing", vectorText(v.geometry().spacing) + " world units"},
        {"origin", vectorText(v.geometry().origin) + " world units"},
        {"frame", v.geometry().frame == Frame::Patient ? "patient (LPS, mm)" : "the file's own"},
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
            {"frame", v.geometry().frame == Frame::Patient ? "patient" : "file"},
            {"directions", directions(v.geometry())},
            {"range", jsonFromRange(v.range())},
            {"data_range", jsonFromRange(v.dataRange())},
            {"invalid", v.invalidCount()},
            {"memory_bytes", v.memoryBytes()},
            {"format", v.format},
            {"title", v.title},
            {"notices", v.notices}};
}

} // namespace

Command addInfo(CLI::App& program) {
    CLI::App* app = program.add_subcommand("info", "What a volume holds: size, type, spacing, range, invalid voxels");
    const auto options = std::make_shared<SceneOptions>();
    options->volume.add(*app);
    options->session.add(*app);
    return {app, [options](Progress& progress) {
                const Opened opened = resolve(*options, progress, {.use = {}, .byEngine = false, .needsTf = false});
                const Volume& volume = *opened.scene.volume;
                return Answer{textOf(volume), jsonOf(volume), opened.sessionNotices, {}};
            }};
}

} // namespace pellucid::cli
