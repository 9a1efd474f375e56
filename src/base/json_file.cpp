#include "base/json_file.h"

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"

namespace pellucid {

using nlohmann::json;

json readJson(const std::string& path) { return parseJson(readText(path), path); }

json parseJson(const std::string& text, const std::string& path) {
    constexpr int kDeepest = 64;
    const auto notTooDeep = [&](int depth, json::parse_event_t, const json&) {
        if (depth > kDeepest)
            throw FileError("its values are nested more than " + std::to_string(kDeepest) + " deep", path,
                            "correct the file");
        return true;
    };
    try {
        return json::parse(text, notTooDeep);
    } catch (const json::parse_error& e) {
        throw FileError("this is not valid JSON (byte " + std::to_string(e.byte) + ")", path, "correct the file");
    } catch (const json::out_of_range&) {
        throw FileError("it has a number that is too large", path, "correct the file");
    }
}

} // namespace pellucid
