// Settings described once: files, options, controls, reports and manuals are made from these descriptions.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include <nlohmann/json_fwd.hpp>

#include "base/color.h"
#include "base/enum_names.h"
#include "base/json_value.h"

namespace pellucid {

/// The numbers that are allowed.
struct NumberRange {
    double lo = 0, hi = 1;
    enum class Open { Neither, Low, High } open = Open::Neither; ///< the end that is not allowed itself

    static constexpr double kInfinity = std::numeric_limits<double>::infinity(); ///< as an end: it is allowed, too
    static constexpr double kFinite = std::numeric_limits<double>::max();        ///< as an end: there is none
    bool holds(double value) const {
        return (open == Open::Low ? value > lo : value >= lo) && (open == Open::High ? value < hi : value <= hi);
    }
    std::string text() const; ///< "from 0 to 1", "above 0 and up to 8", "from 0 to below 1", "from 0 on"
};

/// A value of an enumeration, whichever it is; an optional one may have none.
struct Choice {
    const char* kind; ///< "search method"
    std::span<const char* const> names;
    void* value;
    int (*get)(const void*); ///< index into names; −1: none
    void (*set)(void*, int);

    int index() const { return get(value); }
};
template <NamedEnum E>
Choice choiceOf(E& value) {
    return {kNamesOf<E>.kind, kNamesOf<E>.names, &value, [](const void* v) { return int(*static_cast<const E*>(v)); },
            [](void* v, int index) { *static_cast<E*>(v) = static_cast<E>(index); }};
}
template <NamedEnum E>
Choice choiceOf(std::optional<E>& value) {
    using Optional = std::optional<E>;
    return {kNamesOf<E>.kind, kNamesOf<E>.names, &value,
            [](const void* v) {
                const auto& one = *static_cast<const Optional*>(v);
                return one ? int(*one) : -1;
            },
            [](void* v, int index) {
                *static_cast<Optional*>(v) = index < 0 ? Optional() : Optional(static_cast<E>(index));
            }};
}

/// Where the value of a setting lies.
using SettingValue =
    std::variant<bool*, int*, double*, std::optional<double>*, std::string*, Rgb*, std::optional<Rgb>*, Choice>;
/// Whether it is a number, or may be one.
bool isNumber(const SettingValue& value);

/// A setting of some struct of settings, which the functions below take as `void*`.
struct Setting {
    const char* key;                    ///< in files: "max_iterations"
    SettingValue (*at)(void* settings); ///< member<…>
    const char* words;                  ///< what people call it, with the mnemonic of its control: "&Tolerance"
    const char* help;                   ///< what it does: one or two sentences in full
    NumberRange range = {};
    const char* unit = "";                     ///< of a number: "d0"
    const char* none = nullptr;                ///< what an option says for no value: "auto"; null: leave the option out
    std::span<const char* const> choices = {}; ///< of an enumeration: what controls call its values
    const char* option = nullptr; ///< null: the key with dashes; "no-…": a flag that takes it away; "": none
    bool (*used)(const void* settings) = nullptr;         ///< whether it counts beside the others; null: always
    void (*checkText)(const std::string& text) = nullptr; ///< of a text; throws UsageError

    std::string name() const;       ///< words without the mnemonic
    std::string optionName() const; ///< "--max-iterations"; empty: it has none
    std::string unitText() const;   ///< what stands behind a number: " d0"; empty: it has no unit
    bool isUsed(const void* settings) const { return used == nullptr || used(settings); }
};

/// The settings of a struct: to be specialised beside it.
template <class T>
std::span<const Setting> settingsOf() = delete;

/// `&T::a`, or the way to a member of a member: `member<&T::a, &A::b>`.
template <auto First, auto... Rest>
struct MemberOf;
template <class T, class M, M T::*First, auto... Rest>
struct MemberOf<First, Rest...> {
    static SettingValue at(void* settings) {
        auto& value = ((static_cast<T*>(settings)->*First).*....*Rest);
        using Value = std::remove_reference_t<decltype(value)>;
        if constexpr (requires { choiceOf(value); })
            return choiceOf(value);
        else
            return static_cast<Value*>(&value);
    }
};
template <auto... Members>
inline constexpr auto member = &MemberOf<Members...>::at;

/// The one of this key; there is one.
const Setting& settingOf(std::span<const Setting> settings, std::string_view key);

/// Of a number, a name or a flag: "a number above 0 and up to 8", "thesis or narrow", "true or false". `settings`: any
/// of its kind.
std::string allowedText(const Setting& setting, const void* settings);
/// The value as an option takes it: "0.03", "newton", "#00ff00", "true"; of an empty one Setting::none, else "".
std::string textOf(const Setting& setting, const void* settings);
/// The value for people: that, with its unit, "yes" or "no".
std::string shownText(const Setting& setting, const void* settings);
/// Sets what textOf() gives. Throws UsageError without a place.
void setText(const Setting& setting, void* settings, const std::string& text);
/// Throws UsageError, in the same words, where the value is not allowed.
void check(const Setting& setting, const void* settings);
/// The same of all; `where` is what they are settings of.
void checkAll(std::span<const Setting> settings, const void* values, const std::string& where);
/// Copies the value from one struct to another of the same kind.
void copyValue(const Setting& setting, const void* from, void* to);

/// Into an object: key and value of each. What is empty is left out where it is so in `usual` values, too.
void putSettings(nlohmann::json& object, std::span<const Setting> settings, const void* values, const void* usual);
/// Out of an object; what it does not have stays. Throws Error with the place.
void takeSettings(const JsonValue& object, std::span<const Setting> settings, void* values);

template <class T>
void putSettings(nlohmann::json& object, const T& values) {
    static const T kUsual;
    putSettings(object, settingsOf<T>(), &values, &kUsual);
}
template <class T>
void takeSettings(const JsonValue& object, T& values) {
    takeSettings(object, settingsOf<T>(), &values);
}
template <class T>
void checkSettings(const T& values, const std::string& where) {
    checkAll(settingsOf<T>(), &values, where);
}

} // namespace pellucid
