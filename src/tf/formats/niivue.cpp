// Colour maps of niivue: JSON with lists of 8-bit numbers, up to 256 nodes.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_value.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr int kMostEntries = 256;

bool knowsNiivue(const ForeignFile& file) {
    if (!file.isJson() || !file.json().is_object()) return false;
    const json& j = file.json();
    return j.contains("R") && j.contains("G") && j.contains("B");
}

std::vector<double> bytesOf(const JsonValue& map, const char* key, std::size_t count) {
    std::vector<double> values = map[key].numbers();
    if (values.size() != count) map[key].fail("it has another number of values than R");
    for (double& v : values) {
        if (v < 0 || v > 255) map[key].fail("a value is not between 0 and 255");
        v /= 255;
    }
    return values;
}

/// 0 for the first and 64 of 255 for the others, as niivue has it.
std::vector<double> usualOpacities(std::size_t count) {
    std::vector<double> values(count, 64.0 / 255);
    if (count > 0) values[0] = 0;
    return values;
}

std::vector<double> evenPositions(std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
    return values;
}

ReadTf readNiivue(const ForeignFile& file) {
    const JsonValue map(file.json(), file.path());
    const std::size_t count = map["R"].numbers().size();
    if (count < 2 || count > kMostEntries) map["R"].fail("a map has 2 to 256 nodes");
    const std::vector<double> r = bytesOf(map, "R", count), g = bytesOf(map, "G", count), b = bytesOf(map, "B", count);
    const std::vector<double> a = map.has("A") ? bytesOf(map, "A", count) : usualOpacities(count);
    const std::vector<double> at = map.has("I") ? bytesOf(map, "I", count) : evenPositions(count);
    TfCurves curves;
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0 && at[i] < at[i - 1]) map["I"].fail("the positions are not sorted");
        curves.colors.push_back({at[i], {r[i], g[i], b[i]}, {}});
        curves.opacities.push_back({at[i], a[i], {}});
    }
    ReadTf read = tfOfCurves(curves, ValueRange{0, 1}, file.path());
    if (!map.has("A")) read.notices.emplace_back("without opacities niivue takes 0.25, and 0 for the first node");
    const bool isPlaced = map.has("min") && map.has("max") && map["min"].number() < map["max"].number();
    if (isPlaced && !std::isfinite(map["max"].number() - map["min"].number()))
        map["max"].fail("min and max are too far apart");
    if (isPlaced)
        read.tf.range = ValueRange{map["min"].number(), map["max"].number()};
    else
        read.positions = ValueRange{0, 1};
    keepAs(read.tf, "niivue", map.unknownKeys({"min", "max", "R", "G", "B", "A", "I"}));
    read.tf.validate();
    return read;
}

WrittenTf writeNiivue(const TfToWrite& tf) {
    json map = json::object();
    if (tf.hasRange()) {
        map["min"] = tf.range().lo;
        map["max"] = tf.range().hi;
    }
    TransferFunction all;
    all.points = tf.points({});
    const TfSampler sampler(all);
    std::vector<ControlPoint> table;
    for (const char* key : {"R", "G", "B", "A", "I"}) map[key] = json::array();
    for (int i = 0; i < kMostEntries; ++i) {
        const double x = i / (kMostEntries - 1.0);
        const Rgb c = sampler.color(x);
        table.push_back({x, sampler.opacity(x), c, false, {}});
        map["R"].push_back(eightBits(c.r));
        map["G"].push_back(eightBits(c.g));
        map["B"].push_back(eightBits(c.b));
        map["A"].push_back(eightBits(table.back().opacity));
        map["I"].push_back(i);
    }
    if (const std::string kept = tf.keptOf("niivue"); !kept.empty()) addUnknownKeys(map, kept);
    WrittenTf written;
    written.text = map.dump() + "\n";
    addEightBitLosses(written.losses, table);
    written.losses.emplace_back("positions are those of 256 even steps");
    return written;
}

} // namespace

TfFormat niivueFormat() {
    return {"niivue",
            "niivue colour map",
            "a colour map of niivue",
            ".niivue.json",
            true,
            "features; all is a table of 256 entries with 256 steps",
            &knowsNiivue,
            &readNiivue,
            &writeNiivue};
}

} // namespace pellucid
