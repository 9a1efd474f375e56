#include "tf/formats/tf_json.h"

#include <limits>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr const char* kFormat = "pellucid-tf";
constexpr int kVersion = 1;
constexpr const char* kIdentity = "identity"; ///< of a feature; "id" is a key that other programs may have used

ControlPoint pointFromJson(const JsonValue& j) {
    ControlPoint p;
    p.x = j["x"].number();
    p.opacity = j["opacity"].number();
    p.color = j["color"].color();
    if (j.has("fixed")) p.fixed = j["fixed"].boolean();
    p.extraJson = j.unknownKeys({"x", "opacity", "color", "fixed"});
    return p;
}

ValueRange rangeFromJson(const JsonValue& j) {
    const json& ends = j.json();
    if (!ends.is_array() || ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number())
        j.fail("two numbers [a,b] are expected");
    return {ends[0].get<double>(), ends[1].get<double>()};
}

Feature featureFromJson(const JsonValue& j, Identities identities) {
    Feature f;
    f.name = j["name"].text();
    const ValueRange range = rangeFromJson(j["range"]);
    f.a = range.lo;
    f.b = range.hi;
    f.color = j["color"].color();
    if (j.has("hidden")) f.hidden = j["hidden"].boolean();
    if (identities == Identities::Keep && j.has(kIdentity))
        f.id = static_cast<FeatureId>(j[kIdentity].integer(1, std::numeric_limits<std::int64_t>::max() / 2));
    f.extraJson = identities == Identities::Keep ? j.unknownKeys({"name", "range", "color", "hidden", kIdentity})
                                                 : j.unknownKeys({"name", "range", "color", "hidden"});
    return f;
}

} // namespace

TransferFunction tfFromJson(const JsonValue& j, Identities identities) {
    requireFormat(j, kFormat, kVersion, "give a transfer-function file");
    TransferFunction tf;
    for (const JsonValue& point : j["points"].items()) tf.points.push_back(pointFromJson(point));
    if (j.has("features"))
        for (const JsonValue& f : j["features"].items()) tf.features.push_back(featureFromJson(f, identities));
    if (j.has("range")) tf.range = rangeFromJson(j["range"]);
    tf.extraJson = j.unknownKeys({"format", "version", "range", "points", "features"});
    try {
        tf.validate();
    } catch (const Error& e) {
        throw Error(e.problem(), j.placeOf(e.where()), e.whatToDo());
    }
    if (!j.has("features")) tf.features = deriveFeatures(tf);
    return tf;
}

json jsonFromTf(const TransferFunction& tf, Identities identities) {
    json j = {{"format", kFormat}, {"version", kVersion}, {"points", json::array()}, {"features", json::array()}};
    if (tf.range) j["range"] = {tf.range->lo, tf.range->hi};
    for (const ControlPoint& p : tf.points) {
        json point = {{"x", p.x}, {"opacity", p.opacity}, {"color", jsonFromColor(p.color)}, {"fixed", p.fixed}};
        addUnknownKeys(point, p.extraJson);
        j["points"].push_back(std::move(point));
    }
    for (const Feature& f : tf.features) {
        json feature = {{"name", f.name}, {"range", {f.a, f.b}}, {"color", jsonFromColor(f.color)}};
        if (f.hidden) feature["hidden"] = true;
        addUnknownKeys(feature, f.extraJson);
        if (identities == Identities::Keep && f.id != 0) feature[kIdentity] = f.id;
        j["features"].push_back(std::move(feature));
    }
    addUnknownKeys(j, tf.extraJson);
    return j;
}

TransferFunction readTf(const std::string& path) {
    const json document = readJson(path);
    return tfFromJson(document, path);
}

void writeTf(const TransferFunction& tf, const std::string& path) {
    writeTextAtomically(path, jsonFromTf(tf).dump(2) + "\n");
}

} // namespace pellucid
