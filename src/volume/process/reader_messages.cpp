#include "volume/process/reader_messages.h"

#include <array>
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
constexpr std::size_t kMostLevels = 64;
constexpr int kMostWhole = std::numeric_limits<int>::max();

JsonValue valueOf(const json& message) { return JsonValue(message, "the answer of pellucid-reader"); }

json numbersOf(const Vec3& v) { return json::array({v.x, v.y, v.z}); }
json wholesOf(const Int3& v) { return json::array({v.x, v.y, v.z}); }

Vec3 vectorIn(const JsonValue& value) {
    const std::vector<JsonValue> items = value.items(3);
    return {items[0].number(), items[1].number(), items[2].number()};
}

Int3 wholesIn(const JsonValue& value, int least) {
    const std::vector<JsonValue> items = value.items(3);
    Int3 v;
    for (int a = 0; a < 3; ++a) v[a] = items[static_cast<std::size_t>(a)].whole(least, kMostWhole);
    return v;
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
            {"step", request.step}};
}

ReaderRequest requestIn(const json& message) {
    const JsonValue value = valueOf(message);
    ReaderRequest request;
    request.task = static_cast<ReaderRequest::Task>(value["task"].whole(0, 1));
    request.path = value["path"].text();
    request.array = value["array"].text();
    request.step = value["step"].whole(0, kMostWhole);
    return request;
}

json jsonOf(const ReaderDescription& description) {
    const FileContents& contents = description.contents;
    return {{"files", description.files},
            {"contents",
             {{"dims", wholesOf(contents.dims)},
              {"type", static_cast<int>(contents.type)},
              {"components", contents.components},
              {"steps", contents.steps},
              {"times", contents.times},
              {"unit", contents.timeUnit},
              {"array", contents.array},
              {"arrays", contents.arrays},
              {"details", contents.details}}}};
}

ReaderDescription descriptionIn(const json& message) {
    ReaderDescription description;
    for (const JsonValue& item : valueOf(message)["files"].items()) description.files.push_back(item.text());
    const JsonValue value = valueOf(message)["contents"];
    FileContents& contents = description.contents;
    contents.dims = wholesIn(value["dims"], 1);
    contents.type = static_cast<SampleType>(value["type"].whole(0, static_cast<int>(SampleType::F64)));
    contents.components = value["components"].whole(1, kMostWhole);
    contents.steps = value["steps"].whole(1, kMostWhole);
    contents.times = value["times"].numbers();
    contents.timeUnit = textIn(value["unit"]);
    contents.array = textIn(value["array"]);
    contents.arrays = textsIn(value["arrays"]);
    contents.details = textsIn(value["details"]);
    return description;
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
              {"length_unit", plainSign(layout.lengthUnit)},
              {"array", layout.array},
              {"layers_at_once", answer.layersAtOnce},
              {"notices", layout.notices}};
    for (const ReaderLevel& level : answer.levels)
        text["levels"].push_back({{"dims", wholesOf(level.dims)},
                                  {"factors", wholesOf(level.factors)},
                                  {"spacing", numbersOf(level.spacing)},
                                  {"origin", numbersOf(level.origin)}});
    if (layout.scaling) text["scaling"] = {{"slope", layout.scaling->slope}, {"intercept", layout.scaling->intercept}};
    if (answer.missing) text["missing"] = *answer.missing;
    if (!answer.inFile.empty()) text["in_file"] = {{"starts", answer.inFile}, {"big_endian", layout.bigEndian}};
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
    layout.lengthUnit = lengthUnitNamed(textIn(value["length_unit"])).value_or(LengthUnit::Unknown);
    layout.array = textIn(value["array"]);
    layout.notices = textsIn(value["notices"]);
    layout.bigEndian = std::endian::native == std::endian::big;
    if (value.has("scaling"))
        layout.scaling = ValueScaling{value["scaling"]["slope"].number(), value["scaling"]["intercept"].number()};
    if (value.has("missing")) answer.missing = value["missing"].number();
    answer.layersAtOnce = value["layers_at_once"].whole(1, kMostWhole);
    if (value.has("in_file")) {
        for (const JsonValue& start : value["in_file"]["starts"].items())
            answer.inFile.push_back(
                static_cast<std::uint64_t>(start.integer(0, std::numeric_limits<std::int64_t>::max())));
        layout.bigEndian = value["in_file"]["big_endian"].boolean();
    }
    if (!value.has("levels")) return answer;
    for (const JsonValue& level : value["levels"].items()) {
        if (answer.levels.size() >= kMostLevels) value.fail("there are too many levels", "");
        answer.levels.push_back({wholesIn(level["dims"], 1), wholesIn(level["factors"], 1), vectorIn(level["spacing"]),
                                 vectorIn(level["origin"])});
    }
    return answer;
}

json jsonOf(const ReaderBox& box) {
    return {{"level", box.level},
            {"lo", wholesOf(box.region.lo)},
            {"hi", wholesOf(box.region.hi)},
            {"component", box.component}};
}

ReaderBox boxIn(const json& message) {
    const JsonValue value = valueOf(message);
    return {value["level"].whole(0, kMostWhole),
            {wholesIn(value["lo"], 0), wholesIn(value["hi"], 1)},
            value["component"].whole(0, kMostWhole)};
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

Int3 dimsOf(const ReaderLayout& answer, int level) {
    if (level == 0) return contentsOf(answer.layout).dims;
    const auto n = static_cast<std::size_t>(level - 1);
    if (n >= answer.levels.size()) throw FileError("there is no such level of detail", "", "");
    return answer.levels[n].dims;
}

bool componentsAreApart(const FileLayout& layout) { return layout.axes.back().components; }

std::uint64_t bytesPerVoxel(const FileLayout& layout) {
    const bool areBeside = !componentsAreApart(layout);
    return bytesPerValue(layout.type) *
           (areBeside ? static_cast<std::uint64_t>(contentsOf(layout).components) : std::uint64_t{1});
}

std::uint64_t bytesOf(const ReaderBox& box, const ReaderLayout& answer, const std::string& path) {
    const Int3 dims = dimsOf(answer, box.level), &lo = box.region.lo, &hi = box.region.hi;
    for (int a = 0; a < 3; ++a)
        if (lo[a] < 0 || lo[a] >= hi[a] || hi[a] > dims[a])
            throw FileError("the voxels that are asked for are not there", path, "copy the file again");
    const std::array<std::int64_t, 3> sizes{hi.x - lo.x, hi.y - lo.y, hi.z - lo.z};
    const std::uint64_t bytes = bytesPerVoxel(answer.layout);
    return valueCount(path, sizes, bytes) * bytes;
}

} // namespace pellucid
