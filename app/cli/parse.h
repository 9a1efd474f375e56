// Texts of options → values. Everything here throws UsageError with the option's name as the place.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/enum_names.h"
#include "base/error.h"
#include "render/clipping.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::cli {

/// The parts of `text` between separators, empty ones too: one at least.
std::vector<std::string> split(const std::string& text, char separator);
/// A finite decimal number.
double parseReal(const std::string& text, const std::string& option);
/// The same, in [lo, hi].
double parseRealFrom(const std::string& text, const std::string& option, double lo, double hi);
/// The same, > lo.
double parseRealAbove(const std::string& text, const std::string& option, double lo, double hi);
/// A whole number in [lo, hi].
long long parseInteger(const std::string& text, const std::string& option, long long lo, long long hi);
/// Numbers with commas between; `what` says in the message what is expected ("LO,HI").
std::vector<double> parseReals(const std::string& text, const std::string& option);
std::vector<double> parseReals(const std::string& text, const std::string& option, std::size_t count,
                               const std::string& what);
/// "LO,HI" with LO < HI.
ValueRange parseRange(const std::string& text, const std::string& option);

/// Shares that features are wanted to have: what can be told of them before the features are known. Numbers ≥ 0, not
/// all 0.
std::vector<double> parseTargets(const std::string& text, const std::string& option);

/// The features of this name, ascending. Throws UsageError that lists all there are where it is none of them.
std::vector<std::size_t> parseFeatures(const std::string& text, const std::string& option, const TransferFunction& tf);
/// The first of them.
std::size_t parseFeature(const std::string& text, const std::string& option, const TransferFunction& tf);

struct ImageSize {
    int width = 512, height = 512; ///< pixels, each in [1, kMostPixels]
};
/// "WxH".
ImageSize parseImageSize(const std::string& text, const std::string& option);
/// "#rrggbb", "#rgb" or "R,G,B" with components in [0,1].
Rgb parseColor(const std::string& text, const std::string& option);

/// Two colours for a picture's background, bottom and top.
struct Gradient {
    Rgb bottom;
    std::optional<Rgb> top; ///< empty: one colour
};
/// "COLOUR", or "TOP/BOTTOM" of two.
Gradient parseBackground(const std::string& text, const std::string& option);

struct ClipAxis {
    int axis = 0; ///< 0 x, 1 y, 2 z
    double lo = 0, hi = 1;
};
using Clip = std::variant<ClipAxis, ClipPlane>;
/// "x:a:b", 0 ≤ a < b ≤ 1, or "nx,ny,nz,d" with a normal that is not 0.
Clip parseClip(const std::string& text, const std::string& option);
/// Whether `text` means to be one: it starts with an axis and a colon, or is four numbers.
bool looksLikeClip(const std::string& text);
bool looksLikeNumber(const std::string& text);

/// What `parse()` returns; a UsageError of it gets the option as its place.
template <class Parse>
auto atOption(const std::string& option, const Parse& parse) {
    try {
        return parse();
    } catch (const UsageError& e) {
        throw UsageError(e.problem(), option, e.whatToDo(), e.remedy());
    }
}

/// The value of this name.
template <NamedEnum E>
E parseName(const std::string& text, const std::string& option) {
    return atOption(option, [&] { return fromName<E>(text); });
}
/// Any text, as it is.
inline std::string anyText(const std::string& text, const std::string&) { return text; }

/// The functions above for numbers within [lo, hi], as addValue() takes them.
template <class T>
auto wholeFrom(T lo, T hi) {
    return [lo, hi](const std::string& text, const std::string& option) {
        return static_cast<T>(parseInteger(text, option, static_cast<long long>(lo), static_cast<long long>(hi)));
    };
}
inline auto realFrom(double lo, double hi) {
    return [=](const std::string& text, const std::string& option) { return parseRealFrom(text, option, lo, hi); };
}
/// > lo.
inline auto realAbove(double lo, double hi) {
    return [=](const std::string& text, const std::string& option) { return parseRealAbove(text, option, lo, hi); };
}

/// What checks the text of an option and stores it. A throw inside ends the parsing.
using Take = std::function<void(const std::string& text, const std::string& option)>;
/// Adds an option with one value.
CLI::Option* addValue(CLI::App& app, const std::string& names, const std::string& valueName, const Take& take,
                      const std::string& help, const std::string& group = "Options");
/// The same, may be given several times.
CLI::Option* addRepeated(CLI::App& app, const std::string& names, const std::string& valueName, const Take& take,
                         const std::string& help, const std::string& group = "Options");

/// The same two, which store what `parse(text, option name)` returns. `target` outlives the parsing.
template <class T, class Parse>
CLI::Option* addValue(CLI::App& app, const std::string& names, const std::string& valueName, T& target,
                      const Parse& parse, const std::string& help, const std::string& group = "Options") {
    return addValue(
        app, names, valueName,
        [&target, parse](const std::string& text, const std::string& option) { target = parse(text, option); }, help,
        group);
}
template <class T, class Parse>
CLI::Option* addRepeated(CLI::App& app, const std::string& names, const std::string& valueName, std::vector<T>& target,
                         const Parse& parse, const std::string& help, const std::string& group = "Options") {
    return addRepeated(
        app, names, valueName,
        [&target, parse](const std::string& text, const std::string& option) { target.push_back(parse(text, option)); },
        help, group);
}

/// What has to be given and is not: an option, an argument.
UsageError isRequired(const std::string& what, const std::string& command);
/// Options that do not go together, where it `applies`, and the words of the UsageError.
struct Refusal {
    bool applies;
    const char *what, *option, *whatToDo;
};
/// Throws UsageError for the first that applies.
void refuse(std::initializer_list<Refusal> refusals);

} // namespace pellucid::cli
