// Untrusted JSON, read value by value: every complaint names the file and the place in it.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/color.h"

namespace pellucid {

/// A value inside a JSON document. Refers to the document, which must outlive it. All readers throw Error ("a finite
/// number is expected, a.json at /points/3/x, correct the file").
class JsonValue {
public:
    /// The whole document; `file` is its name in messages.
    JsonValue(const nlohmann::json& document, std::string file) : m_json(&document), m_file(std::move(file)) {}

    const nlohmann::json& json() const { return *m_json; }
    std::string place() const { return placeOf(""); }
    /// The place of what lies at `pointer` ("/points/3") below this value.
    std::string placeOf(const std::string& pointer) const {
        return m_file + (m_pointer.empty() && pointer.empty() ? "" : " at " + m_pointer + pointer);
    }
    [[noreturn]] void fail(const std::string& what, const std::string& whatToDo = "correct the file") const;

    void requireObject() const;
    bool has(const char* key) const;             ///< false where this is no object
    JsonValue operator[](const char* key) const; ///< must be there
    std::vector<JsonValue> items() const;        ///< of a list
    std::vector<JsonValue> items(std::size_t count) const;

    double number() const; ///< finite
    double number(double lo, double hi) const;
    std::vector<double> numbers() const;
    std::int64_t integer(std::int64_t lo, std::int64_t hi) const;
    int whole(int lo, int hi) const; ///< the same, as an int
    bool boolean() const;
    std::string text() const;
    Rgb color() const; ///< "#rrggbb", or [r,g,b] with components in [0,1]

    /// What the object has besides `known`, as one JSON object in text; empty where that is nothing.
    std::string unknownKeys(const std::vector<const char*>& known) const;

private:
    JsonValue(const nlohmann::json& json, std::string file, std::string pointer)
        : m_json(&json), m_file(std::move(file)), m_pointer(std::move(pointer)) {}
    const nlohmann::json* m_json;
    std::string m_file, m_pointer;
};

/// "#rrggbb" where eight bits hold the colour, else three numbers: read back it is the same colour, bit for bit.
nlohmann::json jsonFromColor(const Rgb& color);

/// Checks "format" and "version" of a document of ours. Throws Error: another format, a newer version.
void requireFormat(const JsonValue& document, const char* format, int version, const char* giveInstead);

/// Puts back what unknownKeys() kept.
void addUnknownKeys(nlohmann::json& object, const std::string& extra);

} // namespace pellucid
