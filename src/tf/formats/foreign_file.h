// The text of a file whose format is still to be told: as JSON, as XML, as lines.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace pellucid {

class XmlDocument;

class ForeignFile {
public:
    /// `part`: which one of several in the file is meant, by its name; empty: the first.
    ForeignFile(std::string path, std::string text, std::string part = {});
    ~ForeignFile();

    const std::string& path() const { return m_path; }
    const std::string& text() const { return m_text; }
    const std::string& part() const { return m_part; }

    bool isJson() const { return m_first == '{' || m_first == '['; } ///< by its first character
    bool isXml() const { return m_first == '<'; }                    ///< likewise

    /// The whole document. A comma behind the last value of a list or object is left out, as ParaView writes it.
    /// Throws FileError as readJson() does.
    const nlohmann::json& json() const;
    const XmlDocument& xml() const;                     ///< throws FileError naming the line
    const std::vector<std::string_view>& lines() const; ///< without their ends

private:
    std::string m_path, m_text, m_part;
    char m_first = 0;
    mutable std::unique_ptr<nlohmann::json> m_json;
    mutable std::unique_ptr<XmlDocument> m_xml;
    mutable std::vector<std::string_view> m_lines;
};

/// JSON without commas behind the last value of a list or object.
std::string withoutTrailingCommas(std::string_view text);

} // namespace pellucid
