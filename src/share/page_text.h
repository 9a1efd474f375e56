// Texts as they can stand in a page: whatever comes from outside stays text, and all is ASCII, so that no server's
// idea of an encoding changes it.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace pellucid {

/// For elements and for attributes in quotes: markup and what is not ASCII as character references. Bytes that are no
/// UTF-8, and what turns the direction of writing, become U+FFFD.
std::string htmlText(std::string_view text);

/// For an element `script`: no text in it can end the element or begin a comment.
std::string scriptJson(const nlohmann::json& json);

/// Bytes as printable ASCII without & < \: 13 bits as two digits of base 91, 16/13 characters a byte.
std::string digitsOf(std::span<const unsigned char> bytes);
std::size_t digitCount(std::size_t bytes); ///< characters that digitsOf() makes of so many

/// `text` with each {{name}} replaced by valueOf(name); what is put in is not looked at again.
std::string filled(std::string_view text, const std::function<std::string(const std::string& name)>& valueOf);

/// GLSL of this program's renderer for WebGL: without layout(location = …) and layout(binding = …) before uniforms.
std::string webShader(std::string_view text);

} // namespace pellucid
