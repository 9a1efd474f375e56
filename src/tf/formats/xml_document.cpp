#include "tf/formats/xml_document.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"

namespace pellucid {

XmlDocument::XmlDocument(std::string_view text, const std::string& path) : m_text(text), m_path(path) {
    const pugi::xml_parse_result parsed = m_document.load_buffer(text.data(), text.size());
    if (!parsed) {
        const std::string line = std::to_string(lineOf(static_cast<std::size_t>(parsed.offset)));
        throw FileError("this is not valid XML (" + lowerCase(parsed.description()) + ")", path + ", line " + line,
                        "correct the file");
    }
}

void XmlDocument::fail(const std::string& what, const XmlElement& element) const {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(element.offset_debug(), 0));
    throw FileError(what, m_path + ", line " + std::to_string(lineOf(offset)) + ", " + inQuotes(element.name()),
                    "correct the file");
}

double XmlDocument::number(const XmlElement& element, const char* attribute) const {
    const pugi::xml_attribute a = element.attribute(attribute);
    if (!a) fail(std::string("the attribute ") + attribute + " is missing", element);
    double value = 0;
    if (!parseNumber(trimmed(a.value()), value) || !std::isfinite(value))
        fail(inQuotes(a.value()) + " is not a number", element);
    return value;
}

double XmlDocument::number(const XmlElement& element, const char* attribute, double lo, double hi) const {
    const double value = number(element, attribute);
    if (!(value >= lo && value <= hi))
        fail(inQuotes(element.attribute(attribute).value()) + " is not between " + plainText(lo) + " and " +
                 plainText(hi),
             element);
    return value;
}

double XmlDocument::numberOr(const XmlElement& element, const char* attribute, double otherwise) const {
    return has(element, attribute) ? number(element, attribute) : otherwise;
}

bool XmlDocument::flag(const XmlElement& element, const char* attribute) const {
    const std::string text = lowerCase(trimmed(element.attribute(attribute).value()));
    if (text == "true" || text == "1") return true;
    if (text != "false" && text != "0") fail("true or false is expected", element);
    return false;
}

XmlElement XmlDocument::child(const XmlElement& parent, const char* name) const {
    const XmlElement element = parent.child(name);
    if (!element) fail(std::string("the element ") + name + " is missing", parent);
    return element;
}

std::size_t XmlDocument::lineOf(std::size_t offset) const {
    const std::string_view before = m_text.substr(0, std::min(offset, m_text.size()));
    return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

std::string xmlEscaped(std::string_view text) {
    std::string escaped;
    for (const char c : printable(text)) {
        switch (c) {
        case '&':
            escaped += "&amp;";
            break;
        case '<':
            escaped += "&lt;";
            break;
        case '>':
            escaped += "&gt;";
            break;
        case '"':
            escaped += "&quot;";
            break;
        default:
            escaped += c;
        }
    }
    return escaped;
}

} // namespace pellucid
