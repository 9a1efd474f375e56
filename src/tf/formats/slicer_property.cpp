#include "tf/formats/slicer_property.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

using nlohmann::json;

namespace {

constexpr const char* kKept = "slicer"; ///< of TransferFunction::extraJson

} // namespace

std::vector<double> countedNumbers(std::string_view text, const std::string& where) {
    const std::vector<std::string> words = splitWords(text);
    if (words.empty()) return {};
    std::vector<double> numbers;
    for (const std::string& word : words) {
        double value = 0;
        if (!parseNumber(word, value) || !std::isfinite(value))
            throw FileError(inQuotes(word) + " is not a number", where, "correct the file");
        numbers.push_back(value);
    }
    const double count = numbers.front();
    numbers.erase(numbers.begin());
    if (count != static_cast<double>(numbers.size()))
        throw FileError("it announces " + inQuotes(words.front()) + " numbers but has " +
                            std::to_string(numbers.size()),
                        where, "correct the file");
    return numbers;
}

std::string countedText(const std::vector<double>& numbers) {
    std::string text = std::to_string(numbers.size());
    for (const double v : numbers) text += " " + exactText(v);
    return text;
}

namespace {

void requireGroups(const std::vector<double>& numbers, std::size_t of, const std::string& where) {
    if (numbers.size() % of != 0)
        throw FileError(std::to_string(numbers.size()) + " numbers are no multiple of " + std::to_string(of), where,
                        "correct the file");
}

} // namespace

TfCurves slicerCurves(std::string_view opacities, std::string_view colors, const std::string& where) {
    TfCurves curves;
    const std::vector<double> alpha = countedNumbers(opacities, where + ", opacities");
    requireGroups(alpha, 2, where + ", opacities");
    for (std::size_t i = 0; i < alpha.size(); i += 2) curves.opacities.push_back({alpha[i], alpha[i + 1], {}});
    const std::vector<double> color = countedNumbers(colors, where + ", colours");
    requireGroups(color, 4, where + ", colours");
    for (std::size_t i = 0; i < color.size(); i += 4)
        curves.colors.push_back({color[i], {color[i + 1], color[i + 2], color[i + 3]}, {}});
    return curves;
}

std::string slicerOpacities(const std::vector<ControlPoint>& points, const TfToWrite& tf) {
    std::vector<double> numbers;
    for (const ControlPoint& p : points) numbers.insert(numbers.end(), {tf.value(p.x), p.opacity});
    return countedText(numbers);
}

std::string slicerColors(const std::vector<ControlPoint>& points, const TfToWrite& tf) {
    std::vector<double> numbers;
    for (const ControlPoint& p : points)
        numbers.insert(numbers.end(), {tf.value(p.x), p.color.r, p.color.g, p.color.b});
    return countedText(numbers);
}

bool SlicerLook::gradientMatters() const {
    return std::ranges::any_of(gradient, [](const std::array<double, 2>& p) { return p[1] != 1; });
}

void keepLook(ReadTf& read, const SlicerLook& look, json others) {
    if (look.gradientMatters())
        read.notices.emplace_back("opacity by gradient is kept for 3D Slicer and not drawn here");
    json gradient = json::array();
    for (const auto& [x, y] : look.gradient) gradient.push_back(json::array({x, y}));
    const json kept = {{"interpolation", look.interpolation},
                       {"shade", look.shade},
                       {"ambient", look.ambient},
                       {"diffuse", look.diffuse},
                       {"specular", look.specular},
                       {"specularPower", look.specularPower},
                       {"gradient", std::move(gradient)},
                       {"others", std::move(others)}};
    keepAs(read.tf, kKept, kept.dump());
}

SlicerLook keptLook(const TfToWrite& tf) {
    SlicerLook look;
    const std::string text = tf.keptOf(kKept);
    if (text.empty()) return look;
    const json kept = json::parse(text);
    // Somebody may have edited it: what is not as it was written is as if it were not there.
    const auto number = [&](const char* key, double otherwise) {
        return kept.contains(key) && kept[key].is_number() ? kept[key].get<double>() : otherwise;
    };
    look.interpolation = number("interpolation", 1) == 0 ? 0 : 1;
    look.shade = kept.contains("shade") && kept["shade"] == true;
    look.ambient = number("ambient", look.ambient);
    look.diffuse = number("diffuse", look.diffuse);
    look.specular = number("specular", look.specular);
    look.specularPower = number("specularPower", look.specularPower);
    if (kept.contains("gradient") && kept["gradient"].is_array())
        for (const json& p : kept["gradient"])
            if (p.is_array() && p.size() == 2 && p[0].is_number() && p[1].is_number())
                look.gradient.push_back({p[0].get<double>(), p[1].get<double>()});
    return look;
}

json keptOthers(const TfToWrite& tf) {
    const std::string text = tf.keptOf(kKept);
    const json kept = text.empty() ? json::object() : json::parse(text);
    return kept.contains("others") && kept["others"].is_object() ? kept["others"] : json::object();
}

std::vector<std::array<double, 2>> gradientOf(std::string_view text, const std::string& where) {
    const std::vector<double> numbers = countedNumbers(text, where + ", gradient opacities");
    requireGroups(numbers, 2, where + ", gradient opacities");
    std::vector<std::array<double, 2>> gradient;
    for (std::size_t i = 0; i < numbers.size(); i += 2) gradient.push_back({numbers[i], numbers[i + 1]});
    return gradient;
}

std::string slicerGradient(const SlicerLook& look) {
    if (look.gradient.empty()) return "4 0 1 255 1";
    std::vector<double> numbers;
    for (const auto& [x, y] : look.gradient) numbers.insert(numbers.end(), {x, y});
    return countedText(numbers);
}

} // namespace pellucid
