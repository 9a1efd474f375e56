#include "volume/process/reader_messages.h"

#include <bit>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/json_value.h"
#include "base/text.h"

namespace pellucid {

namespace {

using nlohmann::json;

constexpr int kMostNames = 100'000;
constexpr std::size_t kMostCharacters = 4000;

JsonValue valueOf(const json& message) { return JsonValue(message, "the answer of pellucid-reader"); }

json numbersOf(const Vec3& v) { return json::array({v.x, v.y, v.z}); }

Vec3 vectorIn(const JsonValue& value) {
    const std::vector<JsonValue> items = value.items(3);
    return {items[0].number(), items[1].number(), items[2].number()};
}

std::string textIn(const JsonValue& value) { return printable(value.text().substr(0, kMostCharacters)); }

std::vector<std::string> textsIn(const JsonValue& value) {
    std::vector<std::string> texts;
    for (const JsonValue& item : value.items()) {
        if (texts.size() >= kMostNames) value.fail("there are too many names", "");
        texts.push_back(textIn(item));
    }
    return texts;
}

} // namespace

json jsonOf(const ReaderRequest& request) {
    return {{"task", static_cast<int>(request.task)},
            {"path", request.path},
            {"array", request.array},
            {"step", request.step},
            {"middle_only", request.middleOnly}};
}

ReaderRequest requestIn(const json& message) {
    const JsonValue value = valueOf(message);
    ReaderRequest request;
    request.task = static_cast<ReaderRequest::Task>(value["task"].whole(0, 2));
    request.path = value["path"].text();
    request.array = value["array"].text();
    request.step = value["step"].whole(0, std::numeric_limits<int>::max());
    request.middleOnly = value["middle_only"].boolean();
    return request;
}

json jsonOf(const FileContents& contents) {
    return {{"contents",
             {{"dims", {contents.dims.x, contents.dims.y, contents.dims.z}},
              {"type", static_cast<int>(contents.type)},
              {"components", contents.components},
              {"steps", contents.steps},
              {"times", contents.times},
              {"unit", contents.timeUnit},
              {"array", contents.array},
              {"arrays", contents.arrays},
              {"details", contents.details}}}};
}

FileContents contentsIn(const json& message) {
    const JsonValue value = valueOf(message)["contents"];
    constexpr int kMost = std::numeric_limits<int>::max();
    FileContents contents;
    const std::vector<JsonValue> dims = value["dims"].items(3);
    for (int a = 0; a < 3; ++a) contents.dims[a] = dims[static_cast<std::size_t>(a)].whole(1, kMost);
    contents.type = static_cast<SampleType>(value["type"].whole(0, static_cast<int>(SampleType::F64)));
    contents.components = value["components"].whole(1, kMost);
    contents.steps = value["steps"].whole(1, kMost);
    contents.times = value["times"].numbers();
    contents.timeUnit = textIn(value["unit"]);
    contents.array = textIn(value["array"]);
    contents.arrays = textsIn(value["arrays"]);
    contents.details = textsIn(value["details"]);
    return contents;
}

json jsonOf(const ReaderLayout& answer) {
    const FileLayout& layout = answer.layout;
    json axes = json::array();
    for (const FileAxis& axis : layout.axes)
        axes.push_back({{"size", axis.size}, {"components", axis.components}, {"time", axis.time}});
    json text{{"axes", std::move(axes)},
              {"type", static_cast<int>(layout.type)},
              {"spacing", numbersOf(layout.spacing)},
              {"origin", numbersOf(layout.origin)},
              {"directions",
               {numbersOf(layout.directions[0]), numbersOf(layout.directions[1]), numbersOf(layout.directions[2])}},
              {"patient", layout.worldAxes == WorldAxes::Patient},
              {"array", layout.array},
              {"notices", layout.notices}};
    if (layout.scaling) text["scaling"] = {{"slope", layout.scaling->slope}, {"intercept", layout.scaling->intercept}};
    if (answer.missing) text["missing"] = *answer.missing;
    return {{"layout", std::move(text)}};
}

ReaderLayout layoutIn(const json& message) {
    const JsonValue value = valueOf(message)["layout"];
    ReaderLayout answer;
    FileLayout& layout = answer.layout;
    for (const JsonValue& axis : value["axes"].items())
        layout.axes.push_back({axis["size"].integer(1, std::numeric_limits<std::int32_t>::max()),
                               axis["components"].boolean(), axis["time"].boolean()});
    if (layout.axes.empty() || layout.axes.size() > 17) value.fail("the number of axes cannot be", "");
    layout.type = static_cast<ValueType>(value["type"].whole(0, static_cast<int>(ValueType::F64)));
    layout.spacing = vectorIn(value["spacing"]);
    layout.origin = vectorIn(value["origin"]);
    const std::vector<JsonValue> directions = value["directions"].items(3);
    for (int a = 0; a < 3; ++a) layout.directions[a] = vectorIn(directions[static_cast<std::size_t>(a)]);
    layout.worldAxes = value["patient"].boolean() ? WorldAxes::Patient : WorldAxes::File;
    layout.array = textIn(value["array"]);
    layout.notices = textsIn(value["notices"]);
    layout.bigEndian = std::endian::native == std::endian::big;
    if (value.has("scaling"))
        layout.scaling = ValueScaling{value["scaling"]["slope"].number(), value["scaling"]["intercept"].number()};
    if (value.has("missing")) answer.missing = value["missing"].number();
    return answer;
}

std::vector<std::string> filesIn(const json& message) {
    std::vector<std::string> files;
    for (const JsonValue& item : valueOf(message)["files"].items()) files.push_back(item.text());
    return files;
}

json jsonOf(const Error& error) {
    return {{"error",
             {{"what", error.problem()},
              {"where", error.where()},
              {"do", error.whatToDo()},
              {"usage", dynamic_cast<const UsageError*>(&error) != nullptr}}}};
}

void throwErrorIn(const json& message) {
    const JsonValue error = valueOf(message)["error"];
    const std::string what = textIn(error["what"]), where = textIn(error["where"]), toDo = textIn(error["do"]);
    if (error["usage"].boolean()) throw UsageError(what, where, toDo);
    throw FileError(what, where, toDo);
}

std::uint64_t bytesOf(const FileLayout& layout, const std::string& path) {
    return valuesIn(layout, path) * bytesPerValue(layout.type);
}

} // namespace pellucid
