// What the values of an enumeration are called in files, options and messages: one table beside each enumeration.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

/// The names of the values 0, 1, 2 …, in this order, and what kind of thing they are ("search method").
template <std::size_t N>
struct EnumNames {
    const char* kind;
    std::array<const char*, N> names;
};
template <class... Names>
constexpr EnumNames<sizeof...(Names)> enumNames(const char* kind, Names... names) {
    return {kind, {names...}};
}

/// To be specialised for each enumeration: `template <> inline constexpr auto kNamesOf<Quality> = enumNames(…);`
template <class E>
inline constexpr auto kNamesOf = nullptr;

template <class E>
concept NamedEnum = requires {
    kNamesOf<E>.names;
};

template <NamedEnum E>
constexpr const char* name(E value) {
    return kNamesOf<E>.names[static_cast<std::size_t>(value)];
}

/// All of them, in order.
template <NamedEnum E>
constexpr auto allOf() {
    std::array<E, kNamesOf<E>.names.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<E>(i);
    return all;
}

/// Empty where no value has this name.
template <NamedEnum E>
std::optional<E> findNamed(std::string_view text) {
    for (std::size_t i = 0; i < kNamesOf<E>.names.size(); ++i)
        if (text == kNamesOf<E>.names[i]) return static_cast<E>(i);
    return {};
}

/// The value of this name. Throws UsageError that lists all names.
template <NamedEnum E>
E fromName(const std::string& text) {
    if (const std::optional<E> value = findNamed<E>(text)) return *value;
    throw UsageError(std::string("there is no ") + kNamesOf<E>.kind + " '" + text + "'", "",
                     "give " + anyOf({kNamesOf<E>.names.begin(), kNamesOf<E>.names.end()}));
}

} // namespace pellucid
