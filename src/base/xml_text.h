// Texts in XML and HTML.
#pragma once

#include <string>

namespace pellucid {

/// `text` as it may stand in XML and HTML, between tags and in attributes with double quotes. Control characters, which
/// XML has no way to write, become blanks; bytes that are no UTF-8 become U+FFFD.
std::string escapedXml(const std::string& text);

} // namespace pellucid
