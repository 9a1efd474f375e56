#include "base/csv.h"

#include "base/round_numbers.h"

namespace pellucid {

void CsvTable::add(std::string_view field) {
    if (!m_isFirst) m_text += ',';
    m_isFirst = false;
    m_text += field;
}

CsvTable& CsvTable::operator<<(std::string_view text) {
    std::string field(text);
    if (!field.empty() && std::string_view("=+-@\t\r").find(field.front()) != std::string_view::npos)
        field.insert(0, "'");
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

} // namespace pellucid
