#include "tf/formats/foreign_file.h"

#include <nlohmann/json.hpp>

#include "base/json_file.h"
#include "tf/formats/xml_document.h"

namespace pellucid {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

} // namespace

std::string withoutTrailingCommas(std::string_view text) {
    std::string kept;
    kept.reserve(text.size());
    bool inText = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inText) {
            kept += c;
            if (c == '\\' && i + 1 < text.size())
                kept += text[++i];
            else if (c == '"')
                inText = false;
            continue;
        }
        inText = c == '"';
        if (c == ',') {
            const std::size_t next = text.find_first_not_of(kBlanks, i + 1);
            if (next == std::string_view::npos || text[next] == ']' || text[next] == '}') continue;
        }
        kept += c;
    }
    return kept;
}

ForeignFile::ForeignFile(std::string path, std::string text, std::string part)
    : m_path(std::move(path)), m_text(std::move(text)), m_part(std::move(part)) {
    if (m_text.starts_with("\xEF\xBB\xBF")) m_text.erase(0, 3);
    if (const std::size_t first = m_text.find_first_not_of(kBlanks); first != std::string::npos)
        m_first = m_text[first];
}

ForeignFile::~ForeignFile() = default;

const nlohmann::json& ForeignFile::json() const {
    if (!m_json) m_json = std::make_unique<nlohmann::json>(parseJson(withoutTrailingCommas(m_text), m_path));
    return *m_json;
}

const XmlDocument& ForeignFile::xml() const {
    if (!m_xml) m_xml = std::make_unique<XmlDocument>(m_text, m_path);
    return *m_xml;
}

const std::vector<std::string_view>& ForeignFile::lines() const {
    if (!m_lines.empty()) return m_lines;
    const std::string_view text = m_text;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = text.substr(begin, end - begin);
        if (line.ends_with('\r')) line.remove_suffix(1);
        m_lines.push_back(line);
        begin = end + 1;
    }
    return m_lines;
}

} // namespace pellucid
