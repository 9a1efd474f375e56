#include "session/session_json.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"
#include "base/stored_path.h"
#include "session/ground_file.h"
#include "tf/formats/tf_json.h"
#include "volume/series.h"
#include "volume/spacing.h"

namespace pellucid {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kFormat = "pellucid-session";
constexpr int kVersion = 1;
constexpr double kHuge = std::numeric_limits<double>::max();
constexpr int kMostInt = std::numeric_limits<int>::max();
constexpr int kMostCount = 1'000'000'000; ///< of frames, moves, evaluations

// ---- data files

/// Which bytes a data file has: enough to tell that it is not the one that was saved.
struct Fingerprint {
    std::uint64_t bytes = 0;
    uLong crc = 0;

    std::string crcText() const { ///< eight hexadecimal digits
        std::array<char, 17> text{};
        std::snprintf(text.data(), text.size(), "%08lx", static_cast<unsigned long>(crc));
        return text.data();
    }
};

/// Empty where there is no such file. A file that has not been touched since is not read again.
std::optional<Fingerprint> fingerprintOf(const std::string& path) {
    struct Known {
        std::uintmax_t bytes;
        fs::file_time_type time;
        Fingerprint fingerprint;
    };
    static std::mutex s_mutex;
    static std::map<std::string, Known> s_known;
    std::error_code ec;
    if (!fs::is_regular_file(path, ec)) return {};
    const std::uintmax_t bytes = fs::file_size(path, ec);
    const fs::file_time_type time = fs::last_write_time(path, ec);
    if (ec) return {};
    {
        const std::lock_guard lock(s_mutex);
        const auto known = s_known.find(path);
        if (known != s_known.end() && known->second.bytes == bytes && known->second.time == time)
            return known->second.fingerprint;
    }
    std::ifstream in(path, std::ios::binary);
    std::vector<char> piece(1u << 20);
    uLong crc = ::crc32(0, nullptr, 0);
    std::uint64_t count = 0;
    while (in) {
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        crc = ::crc32(crc, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(in.gcount()));
        count += static_cast<std::uint64_t>(in.gcount());
    }
    const Fingerprint fingerprint{count, crc};
    const std::lock_guard lock(s_mutex);
    s_known[path] = {bytes, time, fingerprint};
    return fingerprint;
}

/// Of all files that the data is in, one after the other: a header and what it names. Of a series those of the first
/// frame: to read them all would take as long as to open them.
std::optional<Fingerprint> fingerprintOf(const VolumeSource& source) {
    VolumeSource first = source;
    if (const std::vector<std::string> files = seriesFiles(source); !files.empty()) first.path = files.front();
    first.more.clear();
    std::vector<std::string> files = filesOf(first);
    if (first.path.ends_with(".pvd")) files.resize(1); // what it names are the frames
    std::optional<Fingerprint> all;
    for (const std::string& path : files) {
        const auto one = fingerprintOf(path);
        if (!one) return {};
        if (!all) {
            all = one;
            continue;
        }
        all->crc = ::crc32_combine(all->crc, one->crc, static_cast<z_off_t>(one->bytes));
        all->bytes += one->bytes;
    }
    return all;
}

std::string storedPath(const std::string& path, const std::string& folder, DataPaths paths) {
    if (paths == DataPaths::Relative) return relativeTo(folder, path);
    std::error_code ec;
    const fs::path absolute = fs::absolute(path, ec);
    return ec ? path : absolute.lexically_normal().string();
}

// ---- writers and readers of the parts, each beside the other

/// What settingsOf<T>() describes of a part.
template <class T>
json from(const T& part) {
    json j = json::object();
    putSettings(j, part);
    return j;
}
template <class T>
T to(const JsonValue& j) {
    T part;
    takeSettings(j, part);
    return part;
}

json fromTf(const TransferFunction& tf) { return jsonFromTf(tf, Identities::Keep); }
TransferFunction toTf(const JsonValue& j) { return tfFromJson(j, Identities::Keep); }

json fromRange(const ValueRange& r) { return {r.lo, r.hi}; }
ValueRange toRange(const JsonValue& j) {
    const auto ends = j.items(2);
    const ValueRange range{ends[0].number(), ends[1].number()};
    if (!(range.lo < range.hi) || !std::isfinite(range.hi - range.lo))
        j.fail("a range needs its lower end below its upper one");
    return range;
}

json fromVec(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 toVec(const JsonValue& j, double lo, double hi) {
    const auto parts = j.items(3);
    return {parts[0].number(lo, hi), parts[1].number(lo, hi), parts[2].number(lo, hi)};
}

json fromSource(const VolumeSource& s, const std::string& folder, DataPaths paths) {
    json j = json::object();
    if (s.isSample()) {
        j["sample"] = s.path.substr(s.path.find(':') + 1);
        if (s.sampleSize != 0) j["size"] = s.sampleSize;
        j["seed"] = s.seed;
    } else {
        j["path"] = storedPath(s.path, folder, paths);
        if (const auto fingerprint = fingerprintOf(s)) {
            j["bytes"] = fingerprint->bytes;
            j["crc32"] = fingerprint->crcText();
        }
    }
    if (s.raw) {
        j["raw"] = {{"dims", {s.raw->dims.x, s.raw->dims.y, s.raw->dims.z}},
                    {"type", name(s.raw->type)},
                    {"endian", s.raw->bigEndian ? "big" : "little"},
                    {"spacing", fromVec(s.spacing.value_or(GridSpacing()).distances)},
                    {"skip", s.raw->skipBytes}};
    }
    for (const std::string& path : s.more) j["more"].push_back(storedPath(path, folder, paths));
    if (s.frames) {
        j["frames"] = {{"first", s.frames->first}, {"stride", s.frames->stride}};
        if (s.frames->last) j["frames"]["last"] = *s.frames->last;
    }
    if (s.step != 0) j["step"] = s.step;
    if (!s.array.empty()) j["array"] = s.array;
    if (s.component != 0) j["component"] = s.component;
    if (s.axes) j["axes"] = gridAxesText(*s.axes);
    if (s.spacing) {
        j["spacing"] = fromVec(s.spacing->distances);
        if (s.spacing->unit != LengthUnit::Unknown) j["unit"] = plainSign(s.spacing->unit);
    }
    if (s.missing) j["missing"] = *s.missing;
    if (s.downsample != 0) j["downsample"] = s.downsample;
    if (s.region)
        j["region"] = {{s.region->lo.x, s.region->lo.y, s.region->lo.z},
                       {s.region->hi.x, s.region->hi.y, s.region->hi.z}};
    return j;
}

RawLayout toRawLayout(const JsonValue& j) {
    RawLayout raw;
    const auto dims = j["dims"].items(3);
    for (int a = 0; a < 3; ++a) raw.dims[a] = dims[static_cast<std::size_t>(a)].whole(1, kMostInt);
    const auto type = findNamed<SampleType>(j["type"].text());
    if (!type) j["type"].fail("no such sample type", "write u8 i8 u16 i16 u32 i32 f32 or f64");
    raw.type = *type;
    const std::string endian = j["endian"].text();
    if (endian != "big" && endian != "little") j["endian"].fail("no such byte order", "write little or big");
    raw.bigEndian = endian == "big";
    raw.skipBytes = static_cast<std::uint64_t>(j["skip"].integer(0, std::numeric_limits<std::int64_t>::max()));
    return raw;
}

GridSpacing toGridSpacing(const JsonValue& j) {
    GridSpacing spacing;
    spacing.distances = toVec(j["spacing"], kLeastSpacing, kMostSpacing);
    if (!j.has("unit")) return spacing;
    const auto unit = lengthUnitNamed(j["unit"].text());
    if (!unit) j["unit"].fail("no such unit of length", "write one such as nm, um, mm, cm, m or in");
    spacing.unit = *unit;
    return spacing;
}

VoxelRegion toRegion(const JsonValue& j) {
    VoxelRegion region;
    const auto ends = j.items(2), lo = ends[0].items(3), hi = ends[1].items(3);
    for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(a);
        region.lo[a] = lo[i].whole(0, kMostInt - 1);
        region.hi[a] = hi[i].whole(region.lo[a] + 1, kMostInt);
    }
    return region;
}

GridAxes toGridAxes(const JsonValue& j) {
    try {
        return parseGridAxes(j.text());
    } catch (const UsageError& e) {
        j.fail(e.problem(), e.whatToDo());
    }
}

VolumeSource toSource(const JsonValue& j, const std::string& folder, std::vector<std::string>& notices) {
    j.requireObject();
    VolumeSource s;
    if (j.has("sample")) {
        s.path = "sample:" + j["sample"].text();
        if (j.has("size")) s.sampleSize = j["size"].whole(8, 65536);
        if (j.has("seed"))
            s.seed = static_cast<std::uint32_t>(j["seed"].integer(0, std::numeric_limits<std::uint32_t>::max()));
    } else {
        const fs::path path = j["path"].text();
        if (path.empty()) j["path"].fail("the name of the data file is empty");
        s.path = foundPath(path, folder);
    }
    if (j.has("raw")) {
        s.raw = toRawLayout(j["raw"]);
        s.spacing = toGridSpacing(j["raw"]); // of sessions that have it nowhere else
        if (*s.spacing == GridSpacing()) s.spacing.reset();
    }
    if (j.has("spacing")) s.spacing = toGridSpacing(j);
    if (j.has("more"))
        for (const JsonValue& path : j["more"].items()) s.more.push_back(foundPath(path.text(), folder));
    if (j.has("frames")) {
        const JsonValue f = j["frames"];
        s.frames = FrameRange{f["first"].whole(0, kMostInt), {}, f["stride"].whole(1, kMostInt)};
        if (f.has("last")) s.frames->last = f["last"].whole(s.frames->first, kMostInt);
    }
    if (j.has("step")) s.step = j["step"].whole(0, kMostInt);
    if (j.has("array")) s.array = j["array"].text();
    if (j.has("component")) s.component = j["component"].whole(0, 1'000'000);
    if (j.has("axes")) s.axes = toGridAxes(j["axes"]);
    if (j.has("missing")) s.missing = j["missing"].number();
    if (j.has("downsample")) s.downsample = j["downsample"].whole(1, 65536);
    if (j.has("region")) s.region = toRegion(j["region"]);
    if (!s.isSample() && j.has("bytes") && j.has("crc32")) {
        const auto bytes = static_cast<std::uint64_t>(j["bytes"].integer(0, INT64_MAX));
        const std::string crc = j["crc32"].text();
        const auto now = fingerprintOf(s);
        if (now && (now->bytes != bytes || now->crcText() != crc))
            notices.push_back("the file " + fs::path(s.path).filename().string() +
                              " is not the one that the session was saved with: its content has changed");
    }
    return s;
}

Derivation toDerivation(const JsonValue& j) {
    try {
        if (const auto derivation = parseDerivation(j.text())) return *derivation;
    } catch (const UsageError& e) {
        j.fail(e.problem());
    }
    j.fail("no such derivation", "write gradient:NAME, volatility:NAME:FRAMES or difference:NAME:FRAME");
}

json fromVariable(const Variable& v, const std::string& folder, DataPaths paths) {
    json j{{"name", v.name}, {"transfer_functions", json::array()}};
    if (v.derivation)
        j["derived"] = v.derivation->text();
    else
        j["source"] = fromSource(v.source, folder, paths);
    if (v.window) j["window"] = fromRange(*v.window);
    for (const auto& [frame, tf] : v.track.keys)
        j["transfer_functions"].push_back({{"frame", frame}, {"tf", fromTf(*tf)}});
    for (const auto& [frame, adapted] : v.track.adapted) {
        json one{{"frame", frame}, {"tf", fromTf(*adapted.tf)}, {"basis", adapted.basis}};
        if (adapted.smooth) {
            one["smooth_tf"] = fromTf(**adapted.smooth);
            one["smooth_basis"] = adapted.smoothBasis;
        }
        j["adapted"].push_back(std::move(one));
    }
    addUnknownKeys(j, v.extraJson);
    return j;
}

Variable toVariable(const JsonValue& j, const std::string& folder, std::vector<std::string>& notices) {
    Variable v;
    v.name = j["name"].text();
    if (j.has("derived"))
        v.derivation = toDerivation(j["derived"]);
    else
        v.source = toSource(j["source"], folder, notices);
    if (j.has("window")) v.window = toRange(j["window"]);
    for (const JsonValue& key : j["transfer_functions"].items())
        v.track.keys[key["frame"].whole(0, kMostCount)] = toTf(key["tf"]);
    if (j.has("adapted"))
        for (const JsonValue& item : j["adapted"].items()) {
            AdaptedTf& adapted = v.track.adapted[item["frame"].whole(0, kMostCount)];
            adapted = {toTf(item["tf"]), item["basis"].text()};
            if (!item.has("smooth_tf")) continue;
            adapted.smooth = toTf(item["smooth_tf"]);
            adapted.smoothBasis = item["smooth_basis"].text();
        }
    v.extraJson = j.unknownKeys({"name", "source", "derived", "window", "transfer_functions", "adapted"});
    return v;
}

json fromTargetKeys(const TargetKeys& keys) {
    json list = json::array();
    for (const auto& [frame, targets] : keys) {
        json item{{"frame", frame}, {"targets", json::array()}};
        for (const auto& [id, target] : targets) item["targets"].push_back({{"id", id}, {"target", target}});
        list.push_back(std::move(item));
    }
    return list;
}
TargetKeys toTargetKeys(const JsonValue& j) {
    TargetKeys keys;
    for (const JsonValue& item : j.items()) {
        auto& targets = keys[item["frame"].whole(0, kMostCount)];
        for (const JsonValue& t : item["targets"].items())
            targets[static_cast<FeatureId>(t["id"].integer(1, INT64_MAX))] = t["target"].number(0, kLargestTarget);
    }
    return keys;
}

json fromHsb(const HsbMapping& h) {
    json j = from(h);
    if (h.found.a) j["found_a"] = {{"of", h.found.saturation}, {"scale", *h.found.a}};
    if (h.found.b) j["found_b"] = {{"of", h.found.brightness}, {"scale", *h.found.b}};
    return j;
}
HsbMapping toHsb(const JsonValue& j) {
    auto h = to<HsbMapping>(j);
    if (j.has("found_a")) {
        h.found.saturation = j["found_a"]["of"].text();
        h.found.a = j["found_a"]["scale"].number(0, kLargestScale);
    }
    if (j.has("found_b")) {
        h.found.brightness = j["found_b"]["of"].text();
        h.found.b = j["found_b"]["scale"].number(0, kLargestScale);
    }
    return h;
}

json fromGround(const GroundView& g, const std::string& folder, DataPaths paths) {
    json j = from(g);
    if (!g.path.empty()) j["source"] = fromSource(sourceOf(g), folder, paths);
    return j;
}
GroundView toGround(const JsonValue& j, const std::string& folder, std::vector<std::string>& notices) {
    auto g = to<GroundView>(j);
    if (j.has("source")) {
        const VolumeSource source = toSource(j["source"], folder, notices);
        g.path = source.path;
        g.raw = source.raw;
        g.missing = source.missing;
    }
    return g;
}

json fromOverlay(const OverlayView& o, const std::string& folder, DataPaths paths) {
    json j = from(o);
    if (!o.isNone()) j["source"] = fromSource(o.source, folder, paths);
    if (o.curve) j["curve"] = fromTf(*o.curve);
    return j;
}
OverlayView toOverlay(const JsonValue& j, const std::string& folder, std::vector<std::string>& notices) {
    auto o = to<OverlayView>(j);
    if (j.has("source")) o.source = toSource(j["source"], folder, notices);
    if (j.has("curve")) o.curve = toTf(j["curve"]);
    return o;
}

json fromGoals(const FeatureGoals& goals) {
    json all = json::array();
    for (const auto& [id, g] : goals) {
        all.push_back(
            {{"id", id}, {"target", g.target}, {"locked", g.locked}, {"lowest", g.lowest}, {"highest", g.highest}});
        if (g.targetLocked) all.back()["target_locked"] = true;
        if (g.departed)
            all.back()["departed"] = {{"name", g.departed->name}, {"range", {g.departed->a, g.departed->b}}};
    }
    return all;
}

FeatureGoals toGoals(const JsonValue& j) {
    FeatureGoals goals;
    for (const JsonValue& item : j.items()) {
        FeatureGoal g;
        g.target = item["target"].number(0, kLargestTarget);
        if (item.has("locked")) g.locked = item["locked"].boolean();
        if (item.has("lowest")) g.lowest = item["lowest"].number(0, 1);
        if (item.has("highest")) g.highest = item["highest"].number(g.lowest, 1);
        if (item.has("target_locked")) g.targetLocked = item["target_locked"].boolean();
        if (item.has("departed")) {
            const JsonValue departed = item["departed"];
            const auto range = departed["range"].items(2);
            g.departed = {departed["name"].text(), range[0].number(0, 1), range[1].number(0, 1)};
        }
        const auto id = static_cast<FeatureId>(item["id"].integer(1, INT64_MAX / 2));
        if (!goals.emplace(id, g).second) item["id"].fail("another feature has this number");
    }
    return goals;
}

json fromMeasure(const MeasureSettings& m) {
    json j = from(m);
    putSettings(j, m.saliency);
    putSettings(j, m.vws);
    return j;
}

MeasureSettings toMeasureSettings(const JsonValue& j) {
    auto m = to<MeasureSettings>(j);
    takeSettings(j, m.saliency);
    takeSettings(j, m.vws);
    if (std::abs(m.vws.u1 + m.vws.u2 - 1) > 1e-9) j["u1"].fail("u1 and u2 do not sum to 1");
    return m;
}

constexpr std::size_t kMostCorners = 10'000; ///< of a region

json fromRefine(const RefineSettings& r) {
    json j = from(r);
    putSettings<RefineSteps>(j, r);
    if (r.intensity) j["intensity"] = *r.intensity;
    if (r.hue) j["hue"] = *r.hue;
    if (r.region)
        for (const glm::dvec2& corner : r.region->outline) j["region"].push_back({corner.x, corner.y});
    if (r.region && r.regionSize[0] > 0) j["region_size"] = r.regionSize;
    return j;
}

RefineSettings toRefine(const JsonValue& j) {
    auto r = to<RefineSettings>(j);
    takeSettings<RefineSteps>(j, r);
    if (j.has("intensity")) r.intensity = j["intensity"].number(0, 1);
    if (j.has("hue")) r.hue = j["hue"].number();
    if (j.has("region")) {
        ImageRegion region;
        for (const JsonValue& corner : j["region"].items()) {
            const auto parts = corner.items(2);
            region.outline.emplace_back(parts[0].number(0, 1), parts[1].number(0, 1));
        }
        if (region.outline.size() < 3 || region.outline.size() > kMostCorners)
            j["region"].fail("an outline has 3 to 10000 corners");
        r.region = std::move(region);
    }
    if (r.region && j.has("region_size")) {
        const auto sides = j["region_size"].items(2);
        for (std::size_t i = 0; i < 2; ++i) r.regionSize[i] = sides[i].whole(1, kMostPixels);
    }
    if ((r.intensity ? 1 : 0) + (r.hue ? 1 : 0) + (r.region ? 1 : 0) > 1)
        j.fail("more than one of intensity, hue and region is favoured", "leave one");
    return r;
}

json fromSlices(const SliceViews& s) {
    json j = from(s);
    if (s.crosshair) j["crosshair"] = fromVec(*s.crosshair);
    if (s.window) j["window"] = fromRange(*s.window);
    return j;
}

SliceViews toSlices(const JsonValue& j) {
    auto s = to<SliceViews>(j);
    if (j.has("crosshair")) s.crosshair = toVec(j["crosshair"], -0.5, 1e9);
    if (j.has("window")) s.window = toRange(j["window"]);
    return s;
}

json fromRulers(const std::vector<Ruler>& rulers) {
    json list = json::array();
    for (const Ruler& r : rulers) {
        json one{{"kind", name(r.kind)},
                 {"name", r.name},
                 {"points", json::array()},
                 {"shown", r.shown},
                 {"number", r.number}};
        for (const Vec3& p : r.points) one["points"].push_back(fromVec(p));
        if (r.kind == RulerKind::Sphere) one["radius"] = r.radius;
        list.push_back(std::move(one));
    }
    return list;
}

std::vector<Ruler> toRulers(const JsonValue& j) {
    constexpr double kFar = 1e30; // as coordinates of the world elsewhere
    std::vector<Ruler> rulers;
    std::set<int> numbers;
    for (const JsonValue& item : j.items()) {
        Ruler r;
        const auto kind = findNamed<RulerKind>(item["kind"].text());
        if (!kind) item["kind"].fail("no such measure", "write distance, angle, sphere or box");
        r.kind = *kind;
        r.name = item["name"].text();
        for (const JsonValue& p : item["points"].items()) r.points.push_back(toVec(p, -kFar, kFar));
        if (r.kind == RulerKind::Sphere) r.radius = item["radius"].number(0, kFar);
        if (item.has("shown")) r.shown = item["shown"].boolean();
        r.number = item["number"].whole(1, kMostCount);
        if (const std::string problem = rulerProblem(r); !problem.empty()) item.fail(problem);
        if (!numbers.insert(r.number).second) item["number"].fail("another measure has this number");
        rulers.push_back(std::move(r));
    }
    if (rulers.size() > kMostRulers) j.fail("these are too many measures");
    return rulers;
}

json fromField(const FieldView& f) {
    json j = from(f);
    j["feature"] = f.feature;
    return j;
}

FieldView toField(const JsonValue& j) {
    auto f = to<FieldView>(j);
    if (j.has("feature")) f.feature = static_cast<FeatureId>(j["feature"].integer(0, INT64_MAX / 2));
    return f;
}

/// A vector of the world.
Vec3 toWorld(const JsonValue& j) { return toVec(j, -1e30, 1e30); }

json fromLight(const Light& l) {
    json j = from(l);
    j["direction"] = fromVec(l.direction);
    return j;
}

Light toLight(const JsonValue& j) {
    auto l = to<Light>(j);
    if (j.has("direction")) l.direction = toWorld(j["direction"]);
    if (!(glm::length(l.direction) > 0)) j["direction"].fail("the light needs a direction that is not 0");
    return l;
}

json fromDisplay(const DisplaySettings& d) {
    json j = from(d);
    j["light"] = fromLight(d.light);
    j["only_feature"] = d.onlyFeature;
    return j;
}

DisplaySettings toDisplay(const JsonValue& j) {
    auto d = to<DisplaySettings>(j);
    if (j.has("shading")) d.light.on = j["shading"].boolean(); // as files without "light" have it
    if (j.has("light")) d.light = toLight(j["light"]);
    if (j.has("only_feature")) d.onlyFeature = static_cast<FeatureId>(j["only_feature"].integer(0, INT64_MAX / 2));
    return d;
}

json fromReference(const AnnotationChoice& r) {
    json j{{"on", r.on}};
    for (const AnnotationPartInfo& part : kAnnotationParts) j[part.name] = r.*part.shown;
    return j;
}

AnnotationChoice toReference(const JsonValue& j) {
    j.requireObject();
    AnnotationChoice r;
    if (j.has("on")) r.on = j["on"].boolean();
    for (const AnnotationPartInfo& part : kAnnotationParts)
        if (j.has(part.name)) r.*part.shown = j[part.name].boolean();
    return r;
}

json fromPart(const BoxPart& part) {
    json j{{"lo", fromVec(part.lo)}, {"hi", fromVec(part.hi)}};
    for (const ClipPlane& plane : part.planes)
        j["planes"].push_back({{"normal", fromVec(plane.normal)}, {"offset", plane.offset}});
    return j;
}

json fromClipping(const Clipping& c) {
    json j = fromPart(c.part());
    if (c.rest.isNone()) return j;
    j["rest"] = fromPart(c.rest.within);
    j["rest"]["density"] = c.rest.density;
    return j;
}

BoxPart toPart(const JsonValue& j) {
    BoxPart part{toVec(j["lo"], 0, 1), toVec(j["hi"], 0, 1), {}};
    if (j.has("planes")) {
        for (const JsonValue& plane : j["planes"].items()) {
            part.planes.push_back({toWorld(plane["normal"]), plane["offset"].number(-1e30, 1e30)});
            if (!(glm::length(part.planes.back().normal) > 0)) plane.fail("a clip plane needs a normal that is not 0");
        }
        if (part.planes.size() > kMostClipPlanes) j["planes"].fail("these are too many planes");
    }
    for (int a = 0; a < 3; ++a)
        if (!(part.lo[a] < part.hi[a])) j.fail("a clip interval needs its lower end below its upper one");
    return part;
}

Clipping toClipping(const JsonValue& j) {
    Clipping c;
    c.setPart(toPart(j));
    if (!j.has("rest")) return c;
    c.rest.within = toPart(j["rest"]);
    c.rest.density = j["rest"]["density"].number(0, 0.999);
    return c;
}

/// With what the other projection would take up again.
json fromCamera(const Camera& camera) {
    json j = jsonFromCamera(camera);
    j["fov_y"] = camera.fovY;
    j["height"] = camera.height;
    return j;
}

json fromComparison(const ComparisonView& c) {
    json j = from(c);
    if (!c.b) return j;
    j["b"] = {{"name", c.b->name},
              {"tf", fromTf(*c.b->tf)},
              {"frame", c.b->frame},
              {"display", fromDisplay(*c.b->display)},
              {"clip", fromClipping(*c.b->clipping)}};
    if (c.b->camera) j["b"]["camera"] = fromCamera(*c.b->camera);
    return j;
}

ComparisonView toComparison(const JsonValue& j) {
    auto c = to<ComparisonView>(j);
    if (!j.has("b")) return c;
    const JsonValue b = j["b"];
    c.b = ComparedState{b["name"].text(),        toTf(b["tf"]),        {}, b["frame"].whole(0, kMostCount),
                        toDisplay(b["display"]), toClipping(b["clip"])};
    if (b.has("camera")) c.b->camera = cameraFromJson(b["camera"]);
    return c;
}

KeyState toKeyState(const JsonValue& j) {
    return {cameraFromJson(j["camera"]), toTf(j["tf"]), toClipping(j["clip"]), toLight(j["light"]),
            j["frame"].whole(0, kMostCount)};
}

json fromRunStart(const RunStart& start) {
    json j{{"tf", fromTf(start.tf)},
           {"camera", fromCamera(start.camera)},
           {"clip", fromClipping(start.clipping)},
           {"measure", fromMeasure(start.measure)},
           {"optimize", from(start.options)},
           {"limits", json::array()}};
    for (const OpacityLimits& l : start.limits)
        j["limits"].push_back({{"lowest", l.lowest}, {"highest", l.highest}, {"locked", l.locked}});
    return j;
}

RunStart toRunStart(const JsonValue& j, std::size_t features) {
    RunStart start;
    start.tf = toTf(j["tf"]);
    start.camera = cameraFromJson(j["camera"]);
    start.clipping = toClipping(j["clip"]);
    start.measure = toMeasureSettings(j["measure"]);
    start.options = to<OptimizeOptions>(j["optimize"]);
    for (const JsonValue& l : j["limits"].items()) {
        start.limits.push_back({l["lowest"].number(0, 1), l["highest"].number(0, 1), l["locked"].boolean()});
        if (start.limits.back().lowest > start.limits.back().highest) l.fail("its bounds are the wrong way round");
    }
    if (start.tf.features.size() != features) j["tf"].fail("the run has another number of features");
    if (!start.limits.empty() && start.limits.size() != features) j["limits"].fail("a feature has one each");
    return start;
}

json fromRun(const Run& r) {
    json history = json::array();
    for (const OptimizeState& s : r.history)
        history.push_back({{"objective", s.objective}, {"vws", s.vws}, {"opacity", s.opacity}, {"level", s.level}});
    json j{{"kind", r.kind},
           {"ended", r.ended},
           {"features", r.features},
           {"targets", r.targets},
           {"history", history},
           {"best", r.best},
           {"before", r.before},
           {"after", r.after},
           {"iterations", r.iterations},
           {"number", r.number},
           {"name", r.name},
           {"started", r.started},
           {"seconds", r.seconds},
           {"evaluations", r.evaluations}};
    if (r.hasStart()) j["start"] = fromRunStart(*r.start);
    return j;
}

Run toRun(const JsonValue& j) {
    Run r;
    r.kind = j["kind"].text();
    r.ended = j["ended"].text();
    for (const JsonValue& name : j["features"].items()) r.features.push_back(name.text());
    const auto perFeature = [&](const JsonValue& numbers) {
        const std::vector<double> all = numbers.numbers();
        if (all.size() != r.features.size()) numbers.fail("each feature of the run has one number");
        return all;
    };
    r.targets = j["targets"].numbers();
    for (const JsonValue& s : j["history"].items()) {
        for (const JsonValue& opacity : s["opacity"].items()) opacity.number(0, 1);
        r.history.push_back({s["objective"].number(0, kMostCount), perFeature(s["vws"]), perFeature(s["opacity"]),
                             s.has("level") ? s["level"].whole(0, 64) : 0});
    }
    if (!r.history.empty()) perFeature(j["targets"]);
    r.best = static_cast<std::size_t>(j["best"].integer(0, INT64_MAX));
    if (r.best > 0 && r.best >= r.history.size()) j["best"].fail("the history has no such state");
    r.before = j["before"].number();
    r.after = j["after"].number();
    r.iterations = j["iterations"].whole(0, kMostCount);
    if (j.has("number")) r.number = j["number"].whole(0, kMostCount);
    if (j.has("name")) r.name = j["name"].text();
    if (j.has("started")) r.started = j["started"].text();
    if (j.has("seconds")) r.seconds = j["seconds"].number(0, kMostCount);
    if (j.has("evaluations")) r.evaluations = j["evaluations"].whole(0, kMostCount);
    if (j.has("start")) r.start = toRunStart(j["start"], r.features.size());
    return r;
}

} // namespace

json jsonFromWholeCamera(const Camera& camera) { return fromCamera(camera); }
json jsonFromClipping(const Clipping& clipping) { return fromClipping(clipping); }
Clipping clippingFromJson(const JsonValue& j) { return toClipping(j); }
json jsonFromLight(const Light& light) { return fromLight(light); }
Light lightFromJson(const JsonValue& j) { return toLight(j); }

json jsonFromKeys(const Keyframes& keys) {
    json array = json::array();
    for (const Keyframe& key : keys) {
        json one{{"time", key.time},
                 {"easing", name(key.easing)},
                 {"camera", fromCamera(key.state.camera)},
                 {"tf", fromTf(key.state.tf)},
                 {"clip", fromClipping(key.state.clipping)},
                 {"light", fromLight(key.state.light)},
                 {"frame", key.state.frame}};
        if (!key.name.empty()) one["name"] = key.name;
        array.push_back(std::move(one));
    }
    return array;
}

Keyframes keysFromJson(const JsonValue& array, const std::function<KeyState(const JsonValue& key)>& state) {
    const std::vector<JsonValue> items = array.items();
    if (items.size() > kMostKeyframes) array.fail("these are too many keys");
    Keyframes keys;
    for (const JsonValue& item : items) {
        Keyframe key;
        key.time = item["time"].number(0, kMostFilmSeconds);
        if (!keys.empty() && !(key.time > keys.back().time + kSameKeyTime))
            item["time"].fail("a key must come later than the one before", "sort the keys by time");
        if (item.has("name")) key.name = item["name"].text();
        if (item.has("easing")) {
            const auto easing = findNamed<Easing>(item["easing"].text());
            if (!easing) item["easing"].fail("no such easing", "write linear, smooth, ease-in, ease-out or hold");
            key.easing = *easing;
        }
        key.state = state(item);
        keys.push_back(std::move(key));
    }
    return keys;
}

json jsonFromSession(const Session& s, const std::string& folder, DataPaths paths) {
    json j{{"format", kFormat},
           {"version", kVersion},
           {"variables", json::array()},
           {"frame", s.frame},
           {"features", fromGoals(*s.goals)},
           {"hold_targets", s.holdTargets},
           {"clip", fromClipping(*s.clipping)},
           {"display", fromDisplay(*s.display)},
           {"reference", fromReference(*s.reference)},
           {"measure", fromMeasure(*s.measure)},
           {"optimize", from(*s.optimize)},
           {"refine", fromRefine(*s.refine)},
           {"slices", fromSlices(*s.slices)},
           {"coordinates", from(*s.coordinates)},
           {"rulers", fromRulers(*s.rulers)},
           {"field", fromField(*s.field)},
           {"picture_saliency", from(*s.pictureSaliency)},
           {"comparison", fromComparison(*s.comparison)},
           {"keyframes", jsonFromKeys(*s.keyframes)},
           {"target_keys", fromTargetKeys(*s.targetKeys)},
           {"adapt", from(*s.adapt)},
           {"hsb", fromHsb(*s.hsb)},
           {"ground", fromGround(*s.ground, folder, paths)},
           {"overlay", fromOverlay(*s.overlay, folder, paths)},
           {"runs", json::array()}};
    for (const Variable& v : *s.variables) j["variables"].push_back(fromVariable(v, folder, paths));
    for (const Run& run : *s.runs) j["runs"].push_back(fromRun(run));
    if (s.density) j["density"] = *s.density;
    if (s.camera) j["camera"] = fromCamera(*s.camera);
    addUnknownKeys(j, s.extraJson);
    return j;
}

SessionFile sessionFromJson(const JsonValue& j, const std::string& folder) {
    requireFormat(j, kFormat, kVersion, "give a session file");
    SessionFile file;
    Session& s = file.session;
    std::vector<Variable> variables;
    for (const JsonValue& v : j["variables"].items()) variables.push_back(toVariable(v, folder, file.notices));
    std::set<std::string> names;
    for (const Variable& v : variables)
        if (!names.insert(v.name).second) j["variables"].fail("each variable needs a name of its own");
    s.variables = std::move(variables);
    if (j.has("frame")) s.frame = j["frame"].whole(0, kMostCount);
    if (j.has("features")) s.goals = toGoals(j["features"]);
    if (j.has("hold_targets")) s.holdTargets = j["hold_targets"].boolean();
    if (j.has("density")) s.density = j["density"].number(0, 1);
    if (j.has("camera")) s.camera = cameraFromJson(j["camera"]);
    if (j.has("clip")) s.clipping = toClipping(j["clip"]);
    if (j.has("display")) s.display = toDisplay(j["display"]);
    if (j.has("reference")) s.reference = toReference(j["reference"]);
    if (j.has("measure")) s.measure = toMeasureSettings(j["measure"]);
    if (j.has("optimize")) s.optimize = to<OptimizeOptions>(j["optimize"]);
    if (j.has("refine")) s.refine = toRefine(j["refine"]);
    if (j.has("slices")) s.slices = toSlices(j["slices"]);
    if (j.has("coordinates")) s.coordinates = to<CoordinateSettings>(j["coordinates"]);
    if (j.has("rulers")) s.rulers = toRulers(j["rulers"]);
    if (j.has("field")) s.field = toField(j["field"]);
    if (j.has("picture_saliency")) s.pictureSaliency = to<PictureSaliencyView>(j["picture_saliency"]);
    if (j.has("comparison")) s.comparison = toComparison(j["comparison"]);
    if (j.has("keyframes")) s.keyframes = keysFromJson(j["keyframes"], toKeyState);
    if (j.has("target_keys")) s.targetKeys = toTargetKeys(j["target_keys"]);
    if (j.has("adapt")) s.adapt = to<AdaptSettings>(j["adapt"]);
    if (j.has("hsb")) s.hsb = toHsb(j["hsb"]);
    if (j.has("ground")) s.ground = toGround(j["ground"], folder, file.notices);
    if (j.has("overlay")) s.overlay = toOverlay(j["overlay"], folder, file.notices);
    if (j.has("runs")) {
        std::vector<Run> runs;
        int highest = 0;
        for (const JsonValue& run : j["runs"].items()) {
            runs.push_back(toRun(run));
            const auto same = [&](const Run& other) { return other.number == runs.back().number; };
            if (runs.back().number == 0 || std::find_if(runs.begin(), runs.end() - 1, same) != runs.end() - 1)
                runs.back().number = highest + 1; // as in files of earlier versions
            highest = std::max(highest, runs.back().number);
        }
        s.runs = std::move(runs);
    }
    s.extraJson = j.unknownKeys(
        {"format",  "version",     "variables", "frame",    "features", "hold_targets",     "camera",     "clip",
         "display", "reference",   "measure",   "optimize", "refine",   "slices",           "field",      "target_keys",
         "adapt",   "hsb",         "ground",    "runs",     "density",  "picture_saliency", "comparison", "title",
         "rulers",  "coordinates", "overlay",   "keyframes"});
    s.identifyFeatures(); // where someone has written the file by hand
    return file;
}

SessionFile readSession(const std::string& path) {
    const json document = readJson(path);
    return sessionFromJson({document, path}, fs::path(path).parent_path().string());
}

void writeSession(const Session& session, const std::string& path, DataPaths paths) {
    std::string text;
    try {
        text = jsonFromSession(session, fs::path(path).parent_path().string(), paths).dump(1) + "\n";
    } catch (const json::type_error&) { // the other texts came from JSON themselves
        throw FileError("the name of the data file is not UTF-8 text, which a session file is made of", path,
                        "rename the data file");
    }
    writeTextAtomically(path, text);
}

} // namespace pellucid
