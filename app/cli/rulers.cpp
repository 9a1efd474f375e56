// `rulers`: distances, angles, and the values in spheres and boxes.
#include "base/atomic_file.h"
#include "commands.h"
#include "options/ruler_options.h"
#include "output_files.h"
#include "render/memory_needs.h"
#include "report/ruler_table.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct RulersArguments {
    SceneOptions scene;
    RulerOptions rulers;
    std::optional<std::string> csv;
};

/// What a session file or the options name, with what they say.
struct Measured {
    std::vector<Ruler> rulers;
    RulerReadings readings = {};
    PatientAxes axes = PatientAxes::Lps;
};

std::string textOf(const Measured& measured, const Scene& scene) {
    const ValueRange& range = scene.volume->dataRange();
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Ruler& ruler : measured.rulers)
        lines.emplace_back(ruler.name,
                           textOf(measured.readings.at(ruler.number), scene.volume->geometry(), range.hi - range.lo));
    return listing(lines);
}

Json jsonOf(const Ruler& ruler, const RulerReading& reading, const Geometry& geometry, PatientAxes axes) {
    Json json{{"name", ruler.name}, {"kind", name(ruler.kind)}, {"points", Json::array()}};
    for (const Vec3& p : inAxes(axes, geometry, ruler).points) json["points"].push_back(jsonFromVector(p));
    if (ruler.kind == RulerKind::Sphere) json["radius"] = ruler.radius;
    if (reading.length) json["length"] = *reading.length;
    if (reading.angle) json["angle"] = *reading.angle;
    if (!reading.values) return json;
    const BodyValues& values = *reading.values;
    json["voxels"] = values.count;
    json["invalid"] = values.invalid;
    json["outside"] = values.outside;
    if (values.count == 0) return json;
    json["mean"] = values.mean;
    json["sigma"] = values.sigma;
    json["range"] = {values.lo, values.hi};
    return json;
}

Json jsonOf(const Measured& measured, const Scene& scene) {
    const Geometry& geometry = scene.volume->geometry();
    Json json{{"command", "rulers"}, {"volume", jsonFromVolume(*scene.volume)}, {"unit", lengthUnit(geometry)}};
    if (geometry.worldAxes == WorldAxes::Patient) json["coordinates"] = name(measured.axes);
    json["rulers"] = Json::array();
    for (const Ruler& ruler : measured.rulers)
        json["rulers"].push_back(jsonOf(ruler, measured.readings.at(ruler.number), geometry, measured.axes));
    return json;
}

Answer run(const RulersArguments& o, Progress& progress) {
    const Opened opened = resolve(o.scene, progress, {.use = {}, .byEngine = false, .needsTf = false});
    const Scene& scene = opened.scene;
    const Geometry& geometry = scene.volume->geometry();
    Measured measured{.rulers = *scene.session.rulers, .axes = scene.session.coordinates->axes};
    o.rulers.applyTo(measured.rulers, measured.axes, geometry);
    if (measured.rulers.empty())
        throw UsageError("there is nothing to measure", "rulers",
                         "give --distance, --angle, --sphere or --box, or a session that holds measures");
    measured.readings = readRulers(measured.rulers, *scene.volume, progress.phase("measuring"));
    if (o.csv) writeTextAtomically(*o.csv, csvOf(measured.rulers, measured.readings, geometry, measured.axes));
    return {textOf(measured, scene), jsonOf(measured, scene), opened.notices()};
}

} // namespace

Command addRulers(CLI::App& program) {
    CLI::App* app = program.add_subcommand("rulers", "Distances and angles; mean, spread and range of the values in "
                                                     "spheres and boxes");
    const auto o = std::make_shared<RulersArguments>();
    o->scene.addForData(*app);
    o->scene.coordinates.add(*app);
    o->rulers.add(*app);
    addOutputFile(*app, "--csv", o->csv, "write them as a table");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
