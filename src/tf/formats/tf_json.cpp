#include "tf/formats/tf_json.h"

#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_file.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr int kVersion = 1;

/// A place inside the document, for messages: file and JSON pointer.
struct Place {
    std::string file, pointer;
    Place operator/(const std::string& key) const { return {file, pointer + "/" + key}; }
    std::string text() const { return file + (pointer.empty() ? "" : " at " + pointer); }
};

[[noreturn]] void fail(const std::string& what, const Place& place, const std::string& whatToDo = "correct the file") {
    throw Error(what, place.text(), whatToDo);
}

const json& need(const json& object, const char* key, const Place& place) {
    const auto it = object.find(key);
    if (it == object.end()) fail(std::string("the key '") + key + "' is missing", place);
    return *it;
}

double needNumber(const json& object, const char* key, const Place& place) {
    const json& v = need(object, key, place);
    if (!v.is_number() || !std::isfinite(v.get<double>())) fail("a finite number is expected", place / key);
    return v.get<double>();
}

Rgb needColor(const json& object, const char* key, const Place& place) {
    const json& v = need(object, key, place);
    if (!v.is_string()) fail("a colour #rrggbb is expected", place / key);
    try {
        return rgbFromHex(v.get<std::string>());
    } catch (const Error& e) {
        fail(e.problem(), place / key, e.whatToDo());
    }
}

std::pair<double, double> needRange(const json& object, const char* key, const Place& place) {
    const json& v = need(object, key, place);
    if (!v.is_array() || v.size() != 2 || !v[0].is_number() || !v[1].is_number())
        fail("two numbers [a,b] are expected", place / key);
    return {v[0].get<double>(), v[1].get<double>()};
}

std::string unknownKeys(const json& object, const std::set<std::string>& known) {
    json rest = json::object();
    for (const auto& [key, value] : object.items())
        if (!known.count(key)) rest[key] = value;
    return rest.empty() ? std::string() : rest.dump();
}

void addUnknownKeys(json& object, const std::string& extra) {
    if (extra.empty()) return;
    const json rest = json::parse(extra);
    for (const auto& [key, value] : rest.items()) object[key] = value;
}

ControlPoint pointFromJson(const json& j, const Place& place) {
    if (!j.is_object()) fail("an object is expected", place);
    ControlPoint p;
    p.x = needNumber(j, "x", place);
    p.opacity = needNumber(j, "opacity", place);
    p.color = needColor(j, "color", place);
    if (const auto it = j.find("fixed"); it != j.end()) {
        if (!it->is_boolean()) fail("true or false is expected", place / "fixed");
        p.fixed = it->get<bool>();
    }
    p.extraJson = unknownKeys(j, {"x", "opacity", "color", "fixed"});
    return p;
}

Feature featureFromJson(const json& j, const Place& place) {
    if (!j.is_object()) fail("an object is expected", place);
    Feature f;
    const json& name = need(j, "name", place);
    if (!name.is_string()) fail("a text is expected", place / "name");
    f.name = name.get<std::string>();
    std::tie(f.a, f.b) = needRange(j, "range", place);
    f.color = needColor(j, "color", place);
    f.extraJson = unknownKeys(j, {"name", "range", "color"});
    return f;
}

} // namespace

TransferFunction tfFromJson(const json& j, const std::string& where) {
    const Place top{where, ""};
    if (!j.is_object()) fail("a JSON object is expected", top);
    const json& format = need(j, "format", top);
    if (format != "pellucid-tf")
        fail("the format is not \"pellucid-tf\"", top / "format", "give a transfer-function file");
    const json& version = need(j, "version", top);
    if (!version.is_number_integer() || version.get<long long>() < 1)
        fail("the version is not a whole number from 1", top / "version");
    if (version.get<long long>() > kVersion)
        fail("version " + version.dump() + " is newer than this program knows", top / "version", "update Pellucid");

    TransferFunction tf;
    const json& points = need(j, "points", top);
    if (!points.is_array()) fail("a list is expected", top / "points");
    for (std::size_t i = 0; i < points.size(); ++i)
        tf.points.push_back(pointFromJson(points[i], top / "points" / std::to_string(i)));
    const auto features = j.find("features");
    if (features != j.end()) {
        if (!features->is_array()) fail("a list is expected", top / "features");
        for (std::size_t i = 0; i < features->size(); ++i)
            tf.features.push_back(featureFromJson((*features)[i], top / "features" / std::to_string(i)));
    }
    if (j.contains("range")) {
        const auto [lo, hi] = needRange(j, "range", top);
        tf.range = ValueRange{lo, hi};
    }
    tf.extraJson = unknownKeys(j, {"format", "version", "range", "points", "features"});
    try {
        tf.validate();
    } catch (const Error& e) {
        fail(e.problem(), Place{where, e.where()}, e.whatToDo());
    }
    if (features == j.end()) tf.features = deriveFeatures(tf);
    return tf;
}

json jsonFromTf(const TransferFunction& tf) {
    json j = {{"format", "pellucid-tf"}, {"version", kVersion}, {"points", json::array()}, {"features", json::array()}};
    if (tf.range) j["range"] = {tf.range->lo, tf.range->hi};
    for (const ControlPoint& p : tf.points) {
        json point = {{"x", p.x}, {"opacity", p.opacity}, {"color", hexFromRgb(p.color)}, {"fixed", p.fixed}};
        addUnknownKeys(point, p.extraJson);
        j["points"].push_back(std::move(point));
    }
    for (const Feature& f : tf.features) {
        json feature = {{"name", f.name}, {"range", {f.a, f.b}}, {"color", hexFromRgb(f.color)}};
        addUnknownKeys(feature, f.extraJson);
        j["features"].push_back(std::move(feature));
    }
    addUnknownKeys(j, tf.extraJson);
    return j;
}

TransferFunction readTf(const std::string& path) { return tfFromJson(readJson(path), path); }

void writeTf(const TransferFunction& tf, const std::string& path) {
    writeTextAtomically(path, jsonFromTf(tf).dump(2) + "\n");
}

TransferFunction loadTf(const std::string& specOrPath) {
    if (auto tf = tfFromSpec(specOrPath)) return *tf;
    return readTf(specOrPath);
}

} // namespace pellucid
