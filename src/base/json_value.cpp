#include "base/json_value.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace pellucid {

void JsonValue::fail(const std::string& what, const std::string& whatToDo) const {
    throw Error(what, place(), whatToDo);
}

void JsonValue::requireObject() const {
    if (!m_json->is_object()) fail(m_pointer.empty() ? "a JSON object is expected" : "an object is expected");
}

bool JsonValue::has(const char* key) const { return m_json->is_object() && m_json->contains(key); }

JsonValue JsonValue::operator[](const char* key) const {
    requireObject();
    const auto it = m_json->find(key);
    if (it == m_json->end()) fail(std::string("the key '") + key + "' is missing");
    return {*it, m_file, m_pointer + "/" + key};
}

std::vector<JsonValue> JsonValue::items() const {
    if (!m_json->is_array()) fail("a list is expected");
    std::vector<JsonValue> all;
    for (std::size_t i = 0; i < m_json->size(); ++i)
        all.push_back({(*m_json)[i], m_file, m_pointer + "/" + std::to_string(i)});
    return all;
}

std::vector<JsonValue> JsonValue::items(std::size_t count) const {
    auto all = items();
    if (all.size() != count) fail("a list of " + std::to_string(count) + " values is expected");
    return all;
}

double JsonValue::number() const {
    if (!m_json->is_number() || !std::isfinite(m_json->get<double>())) fail("a finite number is expected");
    return m_json->get<double>();
}

double JsonValue::number(double lo, double hi) const {
    const double value = number();
    if (!(value >= lo && value <= hi))
        fail("a number from " + nlohmann::json(lo).dump() + " to " + nlohmann::json(hi).dump() + " is expected");
    return value;
}

std::vector<double> JsonValue::numbers() const {
    std::vector<double> all;
    for (const JsonValue& v : items()) all.push_back(v.number());
    return all;
}

std::int64_t JsonValue::integer(std::int64_t lo, std::int64_t hi) const {
    const bool whole =
        m_json->is_number_integer() &&
        !(m_json->is_number_unsigned() && m_json->get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX));
    const std::int64_t value = whole ? m_json->get<std::int64_t>() : 0;
    if (!whole || value < lo || value > hi)
        fail("a whole number from " + std::to_string(lo) + " to " + std::to_string(hi) + " is expected");
    return value;
}

int JsonValue::whole(int lo, int hi) const { return static_cast<int>(integer(lo, hi)); }

bool JsonValue::boolean() const {
    if (!m_json->is_boolean()) fail("true or false is expected");
    return m_json->get<bool>();
}

std::string JsonValue::text() const {
    if (!m_json->is_string()) fail("a text is expected");
    return m_json->get<std::string>();
}

Rgb JsonValue::color() const {
    if (m_json->is_array()) {
        const auto parts = items(3);
        return {parts[0].number(0, 1), parts[1].number(0, 1), parts[2].number(0, 1)};
    }
    if (!m_json->is_string()) fail("a colour is expected", "write \"#rrggbb\" or [r,g,b] from 0 to 1");
    try {
        return rgbFromHex(text());
    } catch (const Error& e) {
        fail(e.problem(), e.whatToDo());
    }
}

std::string JsonValue::unknownKeys(const std::vector<const char*>& known) const {
    nlohmann::json rest = nlohmann::json::object();
    for (const auto& [key, value] : m_json->items())
        if (std::none_of(known.begin(), known.end(), [k = &key](const char* name) { return *k == name; }))
            rest[key] = value;
    return rest.empty() ? std::string() : rest.dump();
}

nlohmann::json jsonFromColor(const Rgb& color) {
    const std::string hex = hexFromRgb(color);
    if (rgbFromHex(hex) == color) return hex;
    return {color.r, color.g, color.b};
}

void requireFormat(const JsonValue& document, const char* format, int version, const char* giveInstead) {
    document.requireObject();
    if (document["format"].json() != format)
        document["format"].fail(std::string("the format is not \"") + format + "\"", giveInstead);
    const JsonValue number = document["version"];
    if (!number.json().is_number_integer() || number.json().get<long long>() < 1)
        number.fail("the version is not a whole number from 1");
    if (number.json().get<long long>() > version)
        number.fail("version " + number.json().dump() + " is newer than this program knows", "update Pellucid");
}

void addUnknownKeys(nlohmann::json& object, const std::string& extra) {
    if (extra.empty()) return;
    const nlohmann::json rest = nlohmann::json::parse(extra);
    for (const auto& [key, value] : rest.items())
        if (!object.contains(key)) object[key] = value;
}

} // namespace pellucid
