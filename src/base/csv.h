// Tables as text (CSV, RFC 4180): commas, texts in quotes where they need them, the same in every locale.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Fields from left to right, line by line.
class CsvTable {
public:
    /// What a spreadsheet would take for a formula (= + − @ in front) gets an apostrophe before it.
    CsvTable& operator<<(std::string_view field);
    CsvTable& operator<<(const char* field) { return *this << std::string_view(field); }
    CsvTable& operator<<(double number); ///< the shortest text that reads back as the same number
    CsvTable& operator<<(int number) { return *this << static_cast<double>(number); }
    /// Nothing: an empty field.
    template <class T>
    CsvTable& operator<<(const std::optional<T>& value) {
        return value ? *this << *value : *this << std::string_view();
    }
    void endLine();

    const std::string& text() const { return m_text; } ///< lines that have ended

private:
    void add(std::string_view field);
    std::string m_text;
    bool m_isFirst = true; ///< of its line
};

/// A table as fields of lines.
struct CsvRecords {
    std::vector<std::vector<std::string>> records;
    std::size_t wholeBytes = 0; ///< what is behind them is a line without an end
};
/// What CsvTable writes, and other programs alike. An apostrophe before what would be a formula is left out, and so are
/// empty lines.
CsvRecords readCsv(std::string_view text);

} // namespace pellucid
