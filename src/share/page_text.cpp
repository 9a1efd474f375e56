#include "share/page_text.h"

#include <array>
#include <cstdint>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/text.h"

namespace pellucid {

namespace {

constexpr unsigned kBase = 91, kBits = 13; // 91² is above 2¹³

std::string digits() {
    std::string all;
    for (char c = '!'; c <= '~'; ++c)
        if (c != '&' && c != '<' && c != '\\') all += c;
    return all;
}

/// Of a character of UTF-8, which printable() has checked, that begins at `at`; moves `at` to its last byte.
std::uint32_t codePoint(std::string_view text, std::size_t& at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
    std::uint32_t code = more == 0 ? first : first & (0x3fu >> more);
    for (int n = 0; n < more && at + 1 < text.size(); ++n)
        code = code << 6 | (static_cast<unsigned char>(text[++at]) & 0x3fu);
    return code;
}

} // namespace

std::string htmlText(std::string_view text) {
    const std::string clean = printable(text);
    std::string html;
    for (std::size_t i = 0; i < clean.size(); ++i) {
        const std::uint32_t code = codePoint(clean, i);
        const bool plain =
            code >= 32 && code < 127 && std::string_view("&<>\"'{}").find(clean[i]) == std::string_view::npos;
        if (plain)
            html += clean[i];
        else
            html += "&#" + std::to_string(code) + ";";
    }
    return html;
}

std::string scriptJson(const nlohmann::json& json) {
    std::string text;
    for (const char c : json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)) {
        if (c == '<' || c == '>' || c == '&') { // only in strings, where this says the same
            std::array<char, 8> escaped{};
            std::snprintf(escaped.data(), escaped.size(), "\\u%04x", static_cast<unsigned>(c));
            text += escaped.data();
        } else {
            text += c;
        }
    }
    return text;
}

std::size_t digitCount(std::size_t bytes) { return 2 * ((8 * bytes + kBits - 1) / kBits); }

std::string digitsOf(std::span<const unsigned char> bytes) {
    static const std::string kDigits = digits();
    PELLUCID_CHECK(kDigits.size() == kBase);
    std::string text;
    text.reserve(digitCount(bytes.size()));
    std::uint32_t held = 0;
    unsigned bits = 0;
    const auto put = [&](std::uint32_t value) {
        text += kDigits[value / kBase];
        text += kDigits[value % kBase];
    };
    for (const unsigned char byte : bytes) {
        held = held << 8 | byte;
        bits += 8;
        if (bits < kBits) continue;
        bits -= kBits;
        put(held >> bits);
        held &= (1u << bits) - 1;
    }
    if (bits > 0) put(held << (kBits - bits));
    return text;
}

namespace {

/// Each piece from `open` to the `close` behind it becomes what `of` makes of what stands between.
std::string replaced(std::string_view text, std::string_view open, std::string_view close,
                     const std::function<std::string(const std::string&)>& of) {
    std::string out;
    std::size_t at = 0;
    for (std::size_t begin = text.find(open); begin != std::string_view::npos; begin = text.find(open, at)) {
        const std::size_t end = text.find(close, begin);
        PELLUCID_CHECK(end != std::string_view::npos);
        out += text.substr(at, begin - at);
        out += of(std::string(text.substr(begin + open.size(), end - begin - open.size())));
        at = end + close.size();
    }
    out += text.substr(at);
    return out;
}

} // namespace

std::string filled(std::string_view text, const std::function<std::string(const std::string&)>& valueOf) {
    return replaced(text, "{{", "}}", valueOf);
}

std::string webShader(std::string_view text) {
    return replaced(text, "layout(", ") ", [](const std::string&) { return std::string(); });
}

} // namespace pellucid
