#include "report/csv.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/csv.h"
#include "report/convergence.h"

namespace pellucid {

namespace {

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

std::string csvOf(std::span<const Run* const> runs) {
    std::vector<Column> columns;
    for (const Run* run : runs)
        for (const Column& c : columnsOf(*run))
            if (std::find(columns.begin(), columns.end(), c) == columns.end()) columns.push_back(c);
    CsvTable csv;
    csv << "run"
        << "method"
        << "move"
        << "level"
        << "F";
    for (const Column& c : columns)
        for (const char* what : {"VWS ", "target ", "opacity "}) csv << what + c.title();
    csv.endLine();
    for (const Run* run : runs) {
        const std::vector<Column> own = columnsOf(*run);
        for (std::size_t i = 0; i < run->history.size(); ++i) {
            const OptimizeState& state = run->history[i];
            csv << titleOf(*run) << methodText(*run) << static_cast<int>(i) << state.level << state.objective;
            for (const Column& c : columns) {
                const auto at = static_cast<std::size_t>(std::find(own.begin(), own.end(), c) - own.begin());
                for (const std::vector<double>* values : {&state.vws, &run->targets, &state.opacity})
                    csv << (at < own.size() && at < values->size() ? std::optional((*values)[at]) : std::nullopt);
            }
            csv.endLine();
        }
    }
    return csv.text();
}

} // namespace pellucid
