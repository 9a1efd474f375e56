// Control points as a table: value, red, green, blue, opacity.
#include <cmath>

#include "base/csv.h"
#include "base/error.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

namespace {

constexpr std::array kColumns{"value", "red", "green", "blue", "opacity"};

bool isHead(const std::vector<std::string>& record) {
    if (record.size() != kColumns.size()) return false;
    for (std::size_t i = 0; i < kColumns.size(); ++i)
        if (lowerCase(trimmed(record[i])) != kColumns[i]) return false;
    return true;
}

bool knowsTable(const ForeignFile& file) {
    if (file.isJson() || file.isXml() || file.lines().empty()) return false;
    const CsvRecords head = readCsv(std::string(file.lines().front()) + "\n");
    return !head.records.empty() && isHead(head.records.front());
}

ReadTf readTable(const ForeignFile& file) {
    const std::string text = file.text().ends_with('\n') ? file.text() : file.text() + "\n";
    const CsvRecords table = readCsv(text);
    if (table.wholeBytes != text.size())
        throw FileError("a text in quotes does not end", file.path(), "close the quotes, or leave them out");
    if (table.records.empty() || !isHead(table.records.front()))
        throw FileError("its first line is not value,red,green,blue,opacity", file.path(),
                        "write it so, and numbers with a point below");
    TfCurves curves;
    for (std::size_t line = 1; line < table.records.size(); ++line) {
        const std::vector<std::string>& record = table.records[line];
        const std::string where = file.path() + ", point " + std::to_string(line);
        if (record.size() != kColumns.size())
            throw FileError("it has " + std::to_string(record.size()) + " of 5 numbers", where,
                            "part numbers by commas, and write decimals with a point");
        std::array<double, 5> v{};
        for (std::size_t i = 0; i < v.size(); ++i)
            if (!parseNumber(trimmed(record[i]), v[i]) || !std::isfinite(v[i]))
                throw FileError(inQuotes(record[i]) + " is not a number", where, "write decimals with a point");
        curves.colors.push_back({v[0], {v[1], v[2], v[3]}, {}});
        curves.opacities.push_back({v[0], v[4], {}});
    }
    return tfOfCurves(curves, {}, file.path());
}

WrittenTf writeTable(const TfToWrite& tf) {
    CsvTable table;
    for (const char* column : kColumns) table << column;
    table.endLine();
    for (const ControlPoint& p : tf.points({})) {
        table << tf.value(p.x) << p.color.r << p.color.g << p.color.b << p.opacity;
        table.endLine();
    }
    return {table.text(), {}};
}

} // namespace

TfFormat csvTfFormat() {
    return {"csv",       "Table",    "a table (CSV)", ".tf.csv", true, "features; opacities hold for one voxel",
            &knowsTable, &readTable, &writeTable};
}

} // namespace pellucid
