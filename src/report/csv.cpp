#include "report/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <vector>

#include "report/convergence.h"

namespace pellucid {

namespace {

/// The shortest text that reads back as the same number.
std::string number(double value) {
    std::array<char, 64> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

/// A feature of a table: the n-th of its name.
struct Column {
    std::string name;
    int occurrence = 0;
    bool operator==(const Column&) const = default;
    std::string title() const { return occurrence == 0 ? name : name + " (" + std::to_string(occurrence + 1) + ")"; }
};

std::vector<Column> columnsOf(const Run& run) {
    std::vector<Column> columns;
    for (const std::string& name : run.features)
        columns.push_back({name, static_cast<int>(std::count_if(columns.begin(), columns.end(),
                                                                [&](const Column& c) { return c.name == name; }))});
    return columns;
}

} // namespace

std::string csvField(const std::string& text) {
    std::string field = text;
    if (!field.empty() && std::string("=+-@\t\r").find(field.front()) != std::string::npos) field.insert(0, "'");
    if (field.find_first_of(",\"\n\r") == std::string::npos) return field;
    std::string quoted = "\"";
    for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string csvOf(std::span<const Run* const> runs) {
    std::vector<Column> columns;
    for (const Run* run : runs)
        for (const Column& c : columnsOf(*run))
            if (std::find(columns.begin(), columns.end(), c) == columns.end()) columns.push_back(c);
    std::string csv = "run,method,move,level,F";
    for (const Column& c : columns)
        for (const char* what : {"VWS ", "target ", "opacity "}) csv += "," + csvField(what + c.title());
    csv += "\n";
    for (const Run* run : runs) {
        const std::vector<Column> own = columnsOf(*run);
        for (std::size_t i = 0; i < run->history.size(); ++i) {
            const OptimizeState& state = run->history[i];
            csv += csvField(titleOf(*run)) + "," + csvField(methodText(*run)) + "," + std::to_string(i) + "," +
                   std::to_string(state.level) + "," + number(state.objective);
            for (const Column& c : columns) {
                const auto at = static_cast<std::size_t>(std::find(own.begin(), own.end(), c) - own.begin());
                for (const std::vector<double>* values : {&state.vws, &run->targets, &state.opacity})
                    csv += "," + (at < own.size() && at < values->size() ? number((*values)[at]) : "");
            }
            csv += "\n";
        }
    }
    return csv;
}

} // namespace pellucid
