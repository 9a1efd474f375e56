#include "base/xml_text.h"

#include <string_view>

#include "base/utf8.h"

namespace pellucid {

std::string escapedXml(const std::string& text) {
    std::string safe;
    std::string_view rest = text;
    while (!rest.empty()) {
        const Character character = firstCharacter(rest);
        const char c = rest.front();
        if (!character.isValid)
            safe += "\xEF\xBF\xBD";
        else if (character.bytes > 1)
            safe += rest.substr(0, character.bytes);
        else if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else if (c == '\'')
            safe += "&#39;";
        else
            safe += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
        rest.remove_prefix(character.bytes);
    }
    return safe;
}

} // namespace pellucid
