// `probe`: what the ray of a pixel meets.
#include "render/probe.h"

#include <cctype>
#include <cmath>

#include <glm/geometric.hpp>

#include "commands.h"
#include "parse.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "volume/orientation.h"

namespace pellucid::cli {

namespace {

struct ProbeArguments {
    SceneOptions scene;
    std::optional<std::string> pixel; ///< "X,Y"
};

/// Whole pixels from the top left corner of the picture.
Int3 parsePixel(const std::string& text, const ImageSize& size) {
    const std::string form = "give the column and the row of a pixel, from 0,0 at the top left to " +
                             std::to_string(size.width - 1) + "," + std::to_string(size.height - 1);
    const auto parts = split(text, ',');
    if (parts.size() != 2) throw UsageError("'" + text + "' is not a pixel", "X,Y", form);
    Int3 pixel(0);
    for (int a = 0; a < 2; ++a) try {
            pixel[a] = static_cast<int>(
                parseInteger(parts[static_cast<std::size_t>(a)], "X,Y", 0, (a == 0 ? size.width : size.height) - 1));
        } catch (const UsageError&) {
            throw UsageError("'" + text + "' is not a pixel of the picture", "X,Y", form);
        }
    return pixel;
}

/// "12,40": with a session the volume is left out, and what stands in its place is the pixel.
bool looksLikePixel(const std::string& text) {
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0 &&
           text.find_first_not_of("0123456789,") == std::string::npos;
}

PatientAxes axesOf(const Scene& scene) { return scene.session.coordinates->axes; }
std::string inParentheses(const std::string& text) { return text.empty() ? text : " (" + text + ")"; }

std::string textOf(const RayProbe& p, const Scene& scene) {
    const TransferFunction& tf = scene.tf;
    const Volume& volume = *scene.volume;
    const std::vector<std::string> names = namesWithEmpty(tf, *scene.histogram);
    if (!p.hit) return "the ray meets nothing of the volume\n";
    const auto percent = [&](double share) { return fixedText(100 * share, 1) + " %"; };
    Table table({"feature", "of the pixel", "of its opacity"});
    const auto ofAlpha = [&](double share) { return p.alpha > 0 ? percent(share / p.alpha) : std::string("-"); };
    for (std::size_t f = 0; f < tf.features.size(); ++f)
        table.add({names[f], percent(p.shares[f]), ofAlpha(p.shares[f])});
    table.add({"(no feature)", percent(p.rest), ofAlpha(p.rest)});
    const std::string unit = std::string(" ") + lengthUnit(volume.geometry());
    std::vector<std::pair<std::string, std::string>> lines{
        {"opacity", fixedText(p.alpha, 4) + ", colour " + hexFromRgb(p.color)},
        {"path", plainText(glm::length(p.exit - p.entry)) + unit + " inside the volume"}};
    if (p.alpha > 0) {
        const auto three = [](const Vec3& v) { return plainText(v.x) + ", " + plainText(v.y) + ", " + plainText(v.z); };
        lines.emplace_back("most", (p.feature >= 0 ? tf.features[static_cast<std::size_t>(p.feature)].name
                                                   : std::string("(no feature)")) +
                                       ", value " + plainText(volume.valueOfIntensity(p.intensity)));
        lines.emplace_back("world", three(inAxes(axesOf(scene), volume.geometry(), p.position)) +
                                        inParentheses(coordinatesText(axesOf(scene), volume.geometry())));
        lines.emplace_back("voxel", three(volume.geometry().voxelFromWorld(p.position)));
    }
    return listing(lines) + table.text();
}

Json jsonOf(const RayProbe& p, const Scene& scene, const Int3& pixel, const ImageSize& size) {
    const TransferFunction& tf = scene.tf;
    const Volume& volume = *scene.volume;
    Json json{{"command", "probe"},
              {"volume", jsonFromVolume(volume)},
              {"pixel", {pixel.x, pixel.y}},
              {"size", {size.width, size.height}},
              {"hit", p.hit},
              {"alpha", p.alpha},
              {"rest", p.rest},
              {"features", Json::array()}};
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        const Feature& feature = tf.features[f];
        json["features"].push_back({{"name", feature.name},
                                    {"range", {feature.a, feature.b}},
                                    {"empty", scene.isEmpty(f)},
                                    {"share", p.shares[f]}});
    }
    if (!p.hit) return json;
    const auto place = [&](const Vec3& world) {
        return jsonFromVector(inAxes(axesOf(scene), volume.geometry(), world));
    };
    if (volume.geometry().worldAxes == WorldAxes::Patient) json["coordinates"] = name(axesOf(scene));
    json["entry"] = place(p.entry);
    json["exit"] = place(p.exit);
    if (p.alpha > 0) {
        json["color"] = hexFromRgb(p.color);
        if (p.feature >= 0) json["feature"] = tf.features[static_cast<std::size_t>(p.feature)].name;
        json["position"] = place(p.position);
        json["voxel"] = jsonFromVector(volume.geometry().voxelFromWorld(p.position));
        json["intensity"] = p.intensity;
        json["value"] = volume.valueOfIntensity(p.intensity);
    }
    json["runs"] = Json::array();
    for (const ProbeRun& run : p.runs) {
        Json one{{"from", run.begin}, {"to", run.end}};
        if (run.feature >= 0) one["feature"] = tf.features[static_cast<std::size_t>(run.feature)].name;
        one["optical_depth"] = run.opticalDepth;
        one["share"] = run.share;
        json["runs"].push_back(std::move(one));
    }
    json["samples"] = Json::array();
    for (const ProbeSample& s : p.samples) {
        Json one{{"t", s.t}};
        if (!std::isnan(s.intensity)) {
            one["intensity"] = s.intensity;
            one["value"] = volume.valueOfIntensity(s.intensity);
        }
        one["opacity"] = s.opacity;
        json["samples"].push_back(std::move(one));
    }
    return json;
}

Answer run(const ProbeArguments& given, Progress& progress) {
    ProbeArguments o = given;
    if (!o.pixel && o.scene.sessionFile && o.scene.volume.path && looksLikePixel(*o.scene.volume.path))
        std::swap(o.pixel, o.scene.volume.path);
    if (!o.pixel) throw isRequired("X,Y", "probe");
    const ImageSize size = o.scene.picture.size;
    const Int3 pixel = parsePixel(*o.pixel, size);
    const Opened opened = resolve(o.scene, progress, {toView("probing")});
    const PictureInput picture = o.scene.picture.pictureOf(opened.scene);
    const RayProbe p = probe(*picture.volume, picture.tf, {picture.camera, picture.settings.clipping}, pixel.x + 0.5,
                             pixel.y + 0.5, size.width, size.height, picture.settings.onlyFeature);
    return {textOf(p, opened.scene), jsonOf(p, opened.scene, pixel, size), opened.notices()};
}

} // namespace

Command addProbe(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("probe", "What the ray of a pixel meets: intensities, opacity, each feature's share");
    const auto o = std::make_shared<ProbeArguments>();
    o->scene.addForView(*app, VolumeOptions::SizeIs::Image);
    app->add_option_function<std::string>(
           "PIXEL", [o](const std::string& text) { o->pixel = text; },
           "X,Y: its column and row, from 0,0 at the top left of the picture")
        ->type_name("");
    addValue(*app, "--size", "WxH", o->scene.picture.size, parseImageSize, "pixels of the picture (default 512x512)");
    o->scene.coordinates.add(*app);
    addValue(*app, "--feature", "NAME", o->scene.picture.feature, anyText, "in the picture of this feature alone");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
