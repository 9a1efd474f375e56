#include "base/setting.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

namespace {

using nlohmann::json;

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// With all its digits; of a whole number no exponent.
std::string wholeOrExactText(double value) {
    constexpr double kMostWhole = 1e15;
    return std::abs(value) < kMostWhole && value == std::floor(value) ? fixedText(value, 0) : exactText(value);
}

/// What files say for a number without end.
constexpr const char* kInfinite = "infinite";

SettingValue valueIn(const Setting& setting, const void* settings) { return setting.at(const_cast<void*>(settings)); }

/// `what` is wrong with the text.
[[noreturn]] void refuse(const Setting& setting, const void* settings, const std::string& what) {
    throw UsageError(what, "", "give " + allowedText(setting, settings));
}

void checkNumber(const Setting& setting, const void* settings, double value) {
    if (!setting.range.holds(value)) refuse(setting, settings, wholeOrExactText(value) + " is out of range");
}

double numberFrom(const Setting& setting, const void* settings, const std::string& text) {
    double value = std::numeric_limits<double>::infinity();
    if (!(text == "inf" && setting.range.holds(value)) && (!parseNumber(text, value) || !std::isfinite(value)))
        refuse(setting, settings, "'" + text + "' is not a number");
    checkNumber(setting, settings, value);
    return value;
}

int integerFrom(const Setting& setting, const void* settings, const std::string& text) {
    std::int64_t value = 0;
    if (!parseNumber(text, value)) refuse(setting, settings, "'" + text + "' is not a whole number");
    checkNumber(setting, settings, static_cast<double>(value));
    return static_cast<int>(value);
}

void choose(const Setting& setting, const void* settings, const Choice& choice, const std::string& text) {
    const auto at = std::find(choice.names.begin(), choice.names.end(), text);
    if (at != choice.names.end())
        choice.set(choice.value, static_cast<int>(at - choice.names.begin()));
    else if (setting.none != nullptr && text == setting.none)
        choice.set(choice.value, -1);
    else
        refuse(setting, settings, std::string("there is no ") + choice.kind + " '" + text + "'");
}

std::string numberText(double value) { return exactText(value); }
std::string colorText(const Rgb& color) {
    const json j = jsonFromColor(color);
    return j.is_string() ? j.get<std::string>()
                         : numberText(color.r) + "," + numberText(color.g) + "," + numberText(color.b);
}

bool isNone(const Setting& setting, const JsonValue& given) {
    return setting.none != nullptr && given.json() == setting.none;
}
/// What jsonNumber() makes.
double numberIn(const JsonValue& given) {
    return given.json() == kInfinite ? std::numeric_limits<double>::infinity() : given.number();
}
json jsonNumber(double value) { return std::isinf(value) ? json(kInfinite) : json(value); }

/// Null where it is empty.
json jsonOf(const Setting& setting, const void* settings) {
    return std::visit(Overloaded{[](const bool* v) { return json(*v); }, [](const int* v) { return json(*v); },
                                 [](const double* v) { return jsonNumber(*v); },
                                 [](const std::optional<double>* v) { return *v ? jsonNumber(**v) : json(); },
                                 [](const std::string* v) { return json(*v); },
                                 [](const Rgb* v) { return jsonFromColor(*v); },
                                 [](const std::optional<Rgb>* v) { return *v ? jsonFromColor(**v) : json(); },
                                 [](const Choice& c) {
                                     const int index = c.index();
                                     return index < 0 ? json() : json(c.names[static_cast<std::size_t>(index)]);
                                 }},
                      valueIn(setting, settings));
}

constexpr double kBeyondAll = 1e100; ///< no data are as far from 0: a bound there need not be told
bool isAny(const NumberRange& range) { return range.lo <= -kBeyondAll && range.hi >= kBeyondAll; }

} // namespace

std::string NumberRange::text() const {
    if (isAny(*this)) return "any number";
    const bool isAbove = open == Open::Low;
    const std::string from = (isAbove ? "above " : "from ") + wholeOrExactText(lo);
    if (hi >= kFinite) return isAbove ? from : from + " on";
    return from + (isAbove ? " and up to " : open == Open::High ? " to below " : " to ") + wholeOrExactText(hi);
}

bool isNumber(const SettingValue& value) {
    return std::holds_alternative<int*>(value) || std::holds_alternative<double*>(value) ||
           std::holds_alternative<std::optional<double>*>(value);
}

std::string Setting::name() const {
    std::string text = words;
    text.erase(std::remove(text.begin(), text.end(), '&'), text.end());
    return text;
}

std::string Setting::optionName() const {
    if (option != nullptr) return *option == '\0' ? std::string() : "--" + std::string(option);
    std::string text = key;
    std::replace(text.begin(), text.end(), '_', '-');
    return "--" + text;
}

std::string Setting::unitText() const { return *unit == '\0' ? std::string() : std::string(" ") + unit; }

const Setting& settingOf(std::span<const Setting> settings, std::string_view key) {
    const auto at = std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return key == s.key; });
    PELLUCID_CHECK(at != settings.end());
    return *at;
}

std::string allowedText(const Setting& setting, const void* settings) {
    const auto number = [&](const char* what) {
        return (isAny(setting.range) ? "" : std::string(what) + ' ') + setting.range.text() +
               (setting.none ? std::string(" or ") + setting.none : "");
    };
    const auto name = [&](const Choice& choice) {
        std::vector<std::string> names(choice.names.begin(), choice.names.end());
        if (setting.none != nullptr) names.emplace_back(setting.none);
        return anyOf(names);
    };
    const SettingValue value = valueIn(setting, settings);
    if (const auto* choice = std::get_if<Choice>(&value)) return name(*choice);
    if (std::holds_alternative<bool*>(value)) return "true or false";
    return number(std::holds_alternative<int*>(value) ? "a whole number" : "a number");
}

std::string textOf(const Setting& setting, const void* settings) {
    const std::string none = setting.none ? setting.none : "";
    return std::visit(Overloaded{[](const bool* v) { return std::string(*v ? "true" : "false"); },
                                 [](const int* v) { return std::to_string(*v); },
                                 [](const double* v) { return numberText(*v); },
                                 [&](const std::optional<double>* v) { return *v ? numberText(**v) : none; },
                                 [](const std::string* v) { return *v; }, [](const Rgb* v) { return colorText(*v); },
                                 [&](const std::optional<Rgb>* v) { return *v ? colorText(**v) : none; },
                                 [&](const Choice& c) {
                                     const int index = c.index();
                                     return index < 0 ? none : std::string(c.names[static_cast<std::size_t>(index)]);
                                 }},
                      valueIn(setting, settings));
}

std::string shownText(const Setting& setting, const void* settings) {
    const SettingValue value = valueIn(setting, settings);
    if (const auto* flag = std::get_if<bool*>(&value)) return **flag ? "yes" : "no";
    const double* number = nullptr;
    if (const auto* v = std::get_if<double*>(&value)) number = *v;
    if (const auto* v = std::get_if<std::optional<double>*>(&value); v != nullptr && **v) number = &***v;
    const std::string text = number != nullptr ? shortText(*number) : textOf(setting, settings);
    return text.empty() ? text : text + setting.unitText();
}

void setText(const Setting& setting, void* settings, const std::string& text) {
    const bool isNone = setting.none != nullptr && text == setting.none;
    std::visit(Overloaded{[&](bool* v) {
                              if (text != "true" && text != "false")
                                  refuse(setting, settings, "'" + text + "' is neither true nor false");
                              *v = text == "true";
                          },
                          [&](int* v) { *v = integerFrom(setting, settings, text); },
                          [&](double* v) { *v = numberFrom(setting, settings, text); },
                          [&](std::optional<double>* v) {
                              *v = isNone ? std::optional<double>() : numberFrom(setting, settings, text);
                          },
                          [&](std::string* v) {
                              if (setting.checkText) setting.checkText(text);
                              *v = text;
                          },
                          [&](Rgb* v) { *v = rgbFromText(text); },
                          [&](std::optional<Rgb>* v) { *v = isNone ? std::optional<Rgb>() : rgbFromText(text); },
                          [&](const Choice& c) { choose(setting, settings, c, text); }},
               setting.at(settings));
}

void check(const Setting& setting, const void* settings) {
    const SettingValue value = valueIn(setting, settings);
    if (const auto* v = std::get_if<int*>(&value)) checkNumber(setting, settings, **v);
    if (const auto* v = std::get_if<double*>(&value)) checkNumber(setting, settings, **v);
    if (const auto* v = std::get_if<std::optional<double>*>(&value); v != nullptr && **v)
        checkNumber(setting, settings, ***v);
    if (const auto* v = std::get_if<std::string*>(&value); v != nullptr && setting.checkText) setting.checkText(**v);
}

void checkAll(std::span<const Setting> settings, const void* values, const std::string& where) {
    for (const Setting& setting : settings) try {
            check(setting, values);
        } catch (const UsageError& e) {
            throw UsageError(setting.name() + ": " + e.problem(), where, e.whatToDo());
        }
}

void copyValue(const Setting& setting, const void* from, void* to) {
    std::visit(
        [&](const auto& source) {
            using Value = std::decay_t<decltype(source)>;
            const auto target = std::get<Value>(setting.at(to));
            if constexpr (std::is_same_v<Value, Choice>)
                target.set(target.value, source.index());
            else
                *target = *source;
        },
        valueIn(setting, from));
}

void putSettings(json& object, std::span<const Setting> settings, const void* values, const void* usual) {
    for (const Setting& setting : settings)
        if (json value = jsonOf(setting, values); !value.is_null())
            object[setting.key] = std::move(value);
        else if (setting.none != nullptr && !jsonOf(setting, usual).is_null())
            object[setting.key] = setting.none;
}

void takeSettings(const JsonValue& object, std::span<const Setting> settings, void* values) {
    object.requireObject();
    for (const Setting& setting : settings) {
        if (!object.has(setting.key)) continue;
        const JsonValue given = object[setting.key];
        try {
            std::visit(
                Overloaded{[&](bool* v) { *v = given.boolean(); }, [&](int* v) { *v = given.whole(INT_MIN, INT_MAX); },
                           [&](double* v) { *v = numberIn(given); },
                           [&](std::optional<double>* v) {
                               *v = isNone(setting, given) ? std::optional<double>() : numberIn(given);
                           },
                           [&](Rgb* v) { *v = given.color(); }, [&](std::optional<Rgb>* v) { *v = given.color(); },
                           [&](auto&&) { setText(setting, values, given.text()); }},
                setting.at(values));
            check(setting, values);
        } catch (const UsageError& e) {
            given.fail(e.problem(), e.whatToDo());
        }
    }
}

} // namespace pellucid
