#include "volume/formats/xml_tags.h"

#include <cctype>
#include <charconv>
#include <cstring>

#include "base/error.h"
#include "base/text.h"

namespace pellucid {

namespace {

constexpr std::size_t kMostTagBytes = 1u << 16;

bool isBlank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// UTF-8 of "#252" or "#xfc"; empty where that is no character.
std::string ofNumber(const std::string& entity) {
    if (entity.size() < 2 || entity[0] != '#') return {};
    const bool hex = entity[1] == 'x' || entity[1] == 'X';
    unsigned code = 0;
    const char *first = entity.data() + (hex ? 2 : 1), *last = entity.data() + entity.size();
    const auto [end, error] = std::from_chars(first, last, code, hex ? 16 : 10);
    if (error != std::errc() || end != last || code == 0 || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
        return {};
    const auto tail = [&](int shift) { return static_cast<char>(0x80 | (code >> shift & 0x3f)); };
    if (code < 0x80) return {static_cast<char>(code)};
    if (code < 0x800) return {static_cast<char>(0xc0 | code >> 6), tail(0)};
    if (code < 0x10000) return {static_cast<char>(0xe0 | code >> 12), tail(6), tail(0)};
    return {static_cast<char>(0xf0 | code >> 18), tail(12), tail(6), tail(0)};
}

} // namespace

std::string withoutEntities(const std::string& text) {
    static const std::map<std::string, std::string> kNamed{
        {"amp", "&"}, {"lt", "<"}, {"gt", ">"}, {"quot", "\""}, {"apos", "'"}};
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        constexpr std::size_t kLongest = 10; // "&#x10ffff;"
        const std::size_t end =
            text[i] == '&' ? std::string_view(text).substr(0, i + kLongest).find(';', i) : std::string::npos;
        const std::string entity = end == std::string::npos ? "" : text.substr(i + 1, end - i - 1);
        const auto named = kNamed.find(entity);
        const std::string character = named != kNamed.end() ? named->second : ofNumber(entity);
        plain += character.empty() ? std::string(1, text[i]) : character;
        if (!character.empty()) i = end;
    }
    return plain;
}

std::string XmlTag::get(const std::string& attribute) const {
    const auto it = attributes.find(attribute);
    return it == attributes.end() ? std::string() : it->second;
}

void XmlTags::fail(const std::string& what) const {
    throw FileError("this is not valid XML: " + what + " near byte " + std::to_string(m_text.passed()), m_path,
                    "copy or write the file again");
}

/// Goes past the next `end`; false where there is none.
bool XmlTags::passOver(const std::string& end) {
    std::string last;
    for (int c = m_text.peek(); c >= 0; c = m_text.peek()) {
        m_text.pass();
        last += static_cast<char>(c);
        if (last.size() > end.size()) last.erase(0, 1);
        if (last == end) return true;
    }
    return false;
}

/// What stands between the "<" that was passed and its ">"; empty where it is no tag, and was passed over.
std::optional<std::string> XmlTags::tagText() {
    static const std::map<std::string, std::string> kEnds{{"!--", "-->"}, {"![CDATA[", "]]>"}, {"?", "?>"}};
    std::string text;
    char quote = 0;
    for (int c = m_text.peek(); c != '>' || quote != 0; c = m_text.peek()) {
        if (c < 0) fail("a tag does not end");
        m_text.pass();
        const char letter = static_cast<char>(c);
        if (quote == 0 && letter == '<') fail("a tag begins within another");
        if (letter == quote)
            quote = 0;
        else if (quote == 0 && (letter == '"' || letter == '\''))
            quote = letter;
        text += letter;
        if (text.size() > kMostTagBytes) fail("a tag is too long");
        const auto end = kEnds.find(text);
        if (end == kEnds.end()) continue;
        if (!passOver(end->second)) fail("a comment does not end");
        return {};
    }
    m_text.pass();
    return text.starts_with('!') ? std::nullopt : std::optional(text);
}

bool XmlTags::next(XmlTag& tag) {
    while (m_text.goTo('<')) {
        m_text.pass();
        const std::optional<std::string> text = tagText();
        if (!text) continue;
        tag = parsed(*text);
        tag.end = m_text.passed();
        return true;
    }
    return false;
}

XmlTag XmlTags::parsed(const std::string& text) const {
    XmlTag tag;
    std::size_t at = 0, end = text.size();
    if (text.starts_with('/')) {
        tag.opens = false;
        tag.closes = true;
        at = 1;
    } else if (text.ends_with('/')) {
        tag.closes = true;
        --end;
    }
    const auto word = [&](const char* until) {
        const std::size_t begin = at;
        while (at < end && !isBlank(text[at]) && std::strchr(until, text[at]) == nullptr) ++at;
        return text.substr(begin, at - begin);
    };
    const auto blanks = [&] {
        while (at < end && isBlank(text[at])) ++at;
    };
    tag.name = word("");
    if (tag.name.empty()) fail("a tag has no name");
    for (blanks(); at < end; blanks()) {
        const std::string name = word("=");
        blanks();
        if (name.empty() || at >= end || text[at] != '=') fail("an attribute has no value");
        ++at;
        blanks();
        const char quote = at < end ? text[at] : '\0';
        const std::size_t close = quote == '"' || quote == '\'' ? text.find(quote, at + 1) : std::string::npos;
        if (close == std::string::npos || close >= end) fail("an attribute has no value");
        if (!tag.attributes.insert({name, withoutEntities(text.substr(at + 1, close - at - 1))}).second)
            fail("the attribute " + inQuotes(name) + " is given twice");
        at = close + 1;
    }
    return tag;
}

} // namespace pellucid
