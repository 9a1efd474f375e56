#include "parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/setting.h"
#include "command_line.h"
#include "output.h"
#include "render/render_settings.h"

namespace pellucid::cli {

namespace {

std::string quoted(const std::string& text) { return "'" + text + "'"; }

template <class T>
std::optional<T> numberIn(const std::string& text) {
    T value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end) return {};
    return value;
}

std::optional<double> finiteIn(const std::string& text) {
    const auto value = numberIn<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

} // namespace

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

double parseReal(const std::string& text, const std::string& option) {
    if (const auto value = finiteIn(text)) return *value;
    throw UsageError(quoted(text) + " is not a number", option, "give a finite decimal number such as 2 or 0.5");
}

double parseRealFrom(const std::string& text, const std::string& option, double lo, double hi) {
    const double value = parseReal(text, option);
    if (value >= lo && value <= hi) return value;
    throw UsageError(text + " is out of range", option, "give a number " + NumberRange{lo, hi}.text());
}

double parseRealAbove(const std::string& text, const std::string& option, double lo, double hi) {
    const double value = parseReal(text, option);
    if (value > lo && value <= hi) return value;
    throw UsageError(text + " is out of range", option,
                     "give a number " + NumberRange{lo, hi, NumberRange::Open::Low}.text());
}

long long parseInteger(const std::string& text, const std::string& option, long long lo, long long hi) {
    const auto value = numberIn<long long>(text);
    if (!value)
        throw UsageError(quoted(text) + " is not a whole number", option,
                         "give one from " + std::to_string(lo) + " to " + std::to_string(hi));
    if (*value < lo || *value > hi)
        throw UsageError(text + " is out of range", option,
                         "give a whole number from " + std::to_string(lo) + " to " + std::to_string(hi));
    return *value;
}

std::vector<double> parseReals(const std::string& text, const std::string& option) {
    std::vector<double> values;
    for (const std::string& part : split(text, ',')) values.push_back(parseReal(part, option));
    return values;
}

std::vector<double> parseReals(const std::string& text, const std::string& option, std::size_t count,
                               const std::string& what) {
    if (split(text, ',').size() != count)
        throw UsageError(quoted(text) + " is not " + std::to_string(count) + " numbers with commas between", option,
                         "give " + what);
    return parseReals(text, option);
}

std::vector<double> parseTargets(const std::string& text, const std::string& option) {
    auto targets = parseReals(text, option);
    double sum = 0;
    for (const double t : targets) {
        if (t < 0) throw UsageError("the target " + plainText(t) + " is negative", option, "give numbers from 0 on");
        if (t > 1e9) throw UsageError("the target " + plainText(t) + " is too large", option, "only proportions count");
        sum += t;
    }
    if (sum == 0) throw UsageError("all targets are 0", option, "give at least one above 0");
    return targets;
}

std::vector<std::size_t> parseFeatures(const std::string& text, const std::string& option, const TransferFunction& tf) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < tf.features.size(); ++i)
        if (tf.features[i].name == text) found.push_back(i);
    if (!found.empty()) return found;
    const std::string known = joined(tf.features, ", ", [](const Feature& f) { return quoted(f.name); });
    throw UsageError("no feature is named " + quoted(text), option,
                     known.empty() ? "leave it out: this transfer function has none" : "known: " + known);
}

std::size_t parseFeature(const std::string& text, const std::string& option, const TransferFunction& tf) {
    return parseFeatures(text, option, tf).front();
}

ValueRange parseRange(const std::string& text, const std::string& option) {
    const auto v = parseReals(text, option, 2, "LO,HI in data units");
    if (!(v[0] < v[1]))
        throw UsageError("the lower end of " + text + " is not below the upper one", option, "give LO,HI with LO < HI");
    if (!std::isfinite(v[1] - v[0]))
        throw UsageError("the ends of " + text + " are too far apart", option, "give LO,HI less than 1e308 apart");
    return {v[0], v[1]};
}

ImageSize parseImageSize(const std::string& text, const std::string& option) {
    const auto parts = split(text, 'x');
    if (parts.size() != 2)
        throw UsageError(quoted(text) + " is not an image size", option, "give WxH in pixels, such as 800x600");
    const auto side = [&](const std::string& part) {
        return static_cast<int>(parseInteger(part, option, 1, kMostPixels));
    };
    return {side(parts[0]), side(parts[1])};
}

Rgb parseColor(const std::string& text, const std::string& option) {
    return atOption(option, [&] { return rgbFromText(text); });
}

Gradient parseBackground(const std::string& text, const std::string& option) {
    const auto parts = split(text, '/');
    if (parts.size() > 2)
        throw UsageError(quoted(text) + " is more than two colours", option, "give one, or TOP/BOTTOM");
    if (parts.size() == 1) return {parseColor(text, option), {}};
    return {parseColor(parts[1], option), parseColor(parts[0], option)};
}

bool looksLikeNumber(const std::string& text) {
    const auto parts = split(text, ',');
    return std::all_of(parts.begin(), parts.end(), [](const std::string& p) { return finiteIn(p).has_value(); });
}

bool looksLikeClip(const std::string& text) {
    const bool axis = text.size() > 1 && text[1] == ':' && text[0] >= 'x' && text[0] <= 'z';
    return axis || (looksLikeNumber(text) && split(text, ',').size() == 4);
}

namespace {

ClipAxis parseClipAxis(const std::string& text, const std::string& option) {
    const auto parts = split(text, ':');
    if (parts.size() != 3)
        throw UsageError(quoted(text) + " is not a part of an axis", option, "give x:A:B with 0 <= A < B <= 1");
    const ClipAxis clip{parts[0][0] - 'x', parseRealFrom(parts[1], option, 0, 1),
                        parseRealFrom(parts[2], option, 0, 1)};
    if (!(clip.lo < clip.hi)) throw UsageError(quoted(text) + " is empty", option, "give x:A:B with 0 <= A < B <= 1");
    return clip;
}

} // namespace

Clip parseClip(const std::string& text, const std::string& option) {
    if (text.size() > 1 && text[1] == ':' && looksLikeClip(text)) return parseClipAxis(text, option);
    if (text.find(',') == std::string::npos)
        throw UsageError(quoted(text) + " is not a clip", option,
                         "give x:A:B, y:A:B, z:A:B, or a plane NX,NY,NZ,D, which keeps NX*x + NY*y + NZ*z <= D");
    const auto v = parseReals(text, option, 4, "NX,NY,NZ,D: a normal, and how far along it is kept");
    const ClipPlane plane{{v[0], v[1], v[2]}, v[3]};
    if (!(glm::length(plane.normal) > 0))
        throw UsageError("the plane " + text + " has no normal", option, "give one that is not 0,0,0");
    return plane;
}

CLI::Option* addValue(CLI::App& app, const std::string& names, const std::string& valueName, const Take& take,
                      const std::string& help, const std::string& group) {
    const std::string option = names.substr(0, names.find(','));
    return app
        .add_option_function<std::string>(
            names, [take, option](const std::string& text) { take(text, option); }, help)
        ->type_name(valueName)
        ->group(group);
}

CLI::Option* addRepeated(CLI::App& app, const std::string& names, const std::string& valueName, const Take& take,
                         const std::string& help, const std::string& group) {
    return app
        .add_option_function<std::vector<std::string>>(
            names,
            [take, names](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) take(text, names);
            },
            help)
        ->type_name(valueName)
        ->allow_extra_args(false)
        ->group(group);
}

UsageError isRequired(const std::string& what, const std::string& command) {
    const std::string program = programName() + " " + command;
    return {what + " is required", program, "see " + program + " --help"};
}

void refuse(std::initializer_list<Refusal> refusals) {
    for (const Refusal& r : refusals)
        if (r.applies) throw UsageError(r.what, r.option, r.whatToDo);
}

} // namespace pellucid::cli
