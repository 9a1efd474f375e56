#include "report/comparison_files.h"

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/text.h"
#include "image_io/image_file.h"

namespace pellucid {

using Json = nlohmann::ordered_json;

namespace {

std::optional<double> valueOf(const ComparedFigure& figure, const std::optional<FeatureFigures>& of) {
    return of ? figure.of(*of) : std::optional<double>();
}

Json jsonOf(const FeatureFigures& figures) {
    Json json = Json::object();
    for (const ComparedFigure& figure : comparedFigures())
        if (const auto value = figure.of(figures)) json[figure.key] = *value;
    return json;
}

} // namespace

std::string csvOf(const Comparison& comparison) {
    CsvTable table;
    table << "feature"
          << "figure"
          << "a"
          << "b"
          << "difference";
    table.endLine();
    for (const FeaturePair& pair : comparison.features)
        for (const ComparedFigure& figure : comparedFigures()) {
            const auto a = valueOf(figure, pair.a), b = valueOf(figure, pair.b);
            if (!a && !b) continue;
            table << pair.name << figure.key << a << b << (a && b ? std::optional(*b - *a) : std::nullopt);
            table.endLine();
        }
    const PictureDifference& d = comparison.difference;
    for (const auto& [name, value] :
         {std::pair{"ssim", d.ssim}, std::pair{"delta_e_mean", d.mean}, std::pair{"delta_e_largest", d.largest},
          std::pair{"delta_e_noticed", d.noticed}}) {
        table << "" << name << ""
              << "" << value;
        table.endLine();
    }
    return table.text();
}

Json jsonOf(const Comparison& comparison) {
    const PictureDifference& d = comparison.difference;
    Json json{{"a", comparison.a},
              {"b", comparison.b},
              {"size", {comparison.imageA.width, comparison.imageA.height}},
              {"ssim", d.ssim},
              {"delta_e", {{"mean", d.mean}, {"largest", d.largest}, {"noticed", d.noticed}}}};
    for (const FeaturePair& pair : comparison.features) {
        Json& feature = json["features"].emplace_back(Json{{"name", pair.name}});
        if (pair.a) feature["a"] = jsonOf(*pair.a);
        if (pair.b) feature["b"] = jsonOf(*pair.b);
    }
    return json;
}

void writeDifference(const PictureDifference& difference, const std::string& path) {
    writePlane(storedDifference(difference.map, lowerCase(path).ends_with(".exr")), path);
}

void writeFigures(const Comparison& comparison, const std::string& path) {
    checkFiguresSuffix(path);
    writeTextAtomically(path,
                        lowerCase(path).ends_with(".csv") ? csvOf(comparison) : jsonOf(comparison).dump(1) + "\n");
}

void checkFiguresSuffix(const std::string& path) {
    const std::string lower = lowerCase(path);
    if (!lower.ends_with(".csv") && !lower.ends_with(".json"))
        throw UsageError("figures are written as .csv or .json", path, "give one of these suffixes");
}

} // namespace pellucid
