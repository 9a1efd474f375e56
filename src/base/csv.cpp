#include "base/csv.h"

#include <utility>

#include "base/round_numbers.h"

namespace pellucid {

namespace {

constexpr std::string_view kFormulaStarts = "=+-@\t\r";

bool beginsFormula(std::string_view text) {
    return !text.empty() && kFormulaStarts.find(text.front()) != std::string_view::npos;
}

std::string withoutGuard(std::string field) {
    if (field.size() > 1 && field.front() == '\'' && beginsFormula(std::string_view(field).substr(1)))
        field.erase(0, 1);
    return field;
}

} // namespace

void CsvTable::add(std::string_view field) {
    if (!m_isFirst) m_text += ',';
    m_isFirst = false;
    m_text += field;
}

CsvTable& CsvTable::operator<<(std::string_view text) {
    std::string field(text);
    if (beginsFormula(field)) field.insert(0, "'");
    if (field.find_first_of(",\"\n\r") != std::string::npos) {
        std::string quoted = "\"";
        for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
        field = quoted + "\"";
    }
    add(field);
    return *this;
}

CsvTable& CsvTable::operator<<(double number) {
    add(exactText(number));
    return *this;
}

void CsvTable::endLine() {
    m_text += '\n';
    m_isFirst = true;
}

CsvRecords readCsv(std::string_view text) {
    CsvRecords table;
    std::vector<std::string> record;
    std::string field;
    bool isQuoted = false;
    const auto endField = [&] { record.push_back(withoutGuard(std::exchange(field, {}))); };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool isLineEnd = c == '\n' || (c == '\r' && i + 1 < text.size() && text[i + 1] == '\n');
        if (c == '"' && isQuoted && i + 1 < text.size() && text[i + 1] == '"') {
            field += text[++i];
        } else if (c == '"') {
            isQuoted = !isQuoted;
        } else if (isQuoted || (c != ',' && !isLineEnd)) {
            field += c;
        } else {
            endField();
            if (c == ',') continue;
            i += c == '\r' ? 1 : 0;
            if (record.size() > 1 || !record.front().empty()) table.records.push_back(record);
            record.clear();
            table.wholeBytes = i + 1;
        }
    }
    return table;
}

} // namespace pellucid
