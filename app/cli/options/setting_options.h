// Options that are made of descriptions of settings (base/setting.h).
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/setting.h"

namespace pellucid::cli {

/// What `--help` says of a setting: what it does, its range, and its usual value.
std::string helpOf(const Setting& setting, const void* usual);

/// Adds the option of one setting, which sets it in `values` and appends it to `given`. The three outlive the parsing.
CLI::Option* addSetting(CLI::App& app, const Setting& setting, void* values, std::vector<const Setting*>& given,
                        const std::string& group);

/// What was given for settings of a T, to be laid over those of a session.
template <class T>
class SettingOptions {
public:
    /// Options for the settings of these keys; without keys, for all that have one.
    void add(CLI::App& app, const std::string& group = "Options", std::initializer_list<const char*> keys = {}) {
        for (const Setting& setting : settingsOf<T>())
            if (keys.size() == 0 ? !setting.optionName().empty()
                                 : std::find(keys.begin(), keys.end(), std::string_view(setting.key)) != keys.end())
                addSetting(app, setting, &m_values, m_given, group);
    }
    void applyTo(T& settings) const {
        for (const Setting* setting : m_given) copyValue(*setting, &m_values, &settings);
    }
    /// As if the option had been given with this text. Throws UsageError without a place.
    void take(const Setting& setting, const std::string& text) {
        setText(setting, &m_values, text);
        m_given.push_back(&setting);
    }

    const std::vector<const Setting*>& given() const { return m_given; }
    bool has(const char* key) const {
        return std::any_of(m_given.begin(), m_given.end(),
                           [&](const Setting* s) { return std::string_view(key) == s->key; });
    }
    const T& values() const { return m_values; } ///< usual ones where none were given

private:
    T m_values;
    std::vector<const Setting*> m_given;
};

} // namespace pellucid::cli
