// XML as untrusted input: every complaint names the file, the line and the element.
#pragma once

#include <string>
#include <string_view>

#include <pugixml.hpp>

namespace pellucid {

using XmlElement = pugi::xml_node;

/// Elements of one document and where they stand in it. `text` and `path` must outlive it.
class XmlDocument {
public:
    /// Throws FileError where it is none.
    XmlDocument(std::string_view text, const std::string& path);

    XmlElement root() const { return m_document.document_element(); } ///< the first element
    XmlElement document() const { return m_document; }                ///< what holds it, and others beside it

    [[noreturn]] void fail(const std::string& what, const XmlElement& element) const; ///< throws FileError

    bool has(const XmlElement& element, const char* attribute) const { return element.attribute(attribute) != nullptr; }
    /// A finite number; throws where the attribute is missing.
    double number(const XmlElement& element, const char* attribute) const;
    double number(const XmlElement& element, const char* attribute, double lo, double hi) const;
    double numberOr(const XmlElement& element, const char* attribute, double otherwise) const;
    bool flag(const XmlElement& element, const char* attribute = "value") const; ///< true, false, 1 or 0
    XmlElement child(const XmlElement& parent, const char* name) const;          ///< must be there

private:
    std::size_t lineOf(std::size_t offset) const;

    std::string_view m_text;
    const std::string& m_path;
    pugi::xml_document m_document;
};

/// A text as the value of an attribute.
std::string xmlEscaped(std::string_view text);

} // namespace pellucid
