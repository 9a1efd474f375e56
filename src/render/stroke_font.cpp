#include "render/stroke_font.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <string>

namespace pellucid {

namespace {

// Glyphs are drawn on a grid where a capital is 10 high, a small letter 7, and nothing goes below -3.
constexpr double kCapital = 10;
constexpr double kBetween = 2.5; // from glyph to glyph
constexpr double kBlank = 1.2;   // of a space, beside what lies between glyphs

/// A path: "M x y" begins a line, "L x y" goes on, "A cx cy rx ry from to" goes on along an ellipse (degrees,
/// counterclockwise where from < to), "E cx cy rx ry" is a whole one.
struct Drawn {
    char32_t character;
    double width;
    const char* path;
};

constexpr Drawn kGlyphs[] = {
    {U'!', 0, "M0 10 L0 3 M0 0.1 L0 0"},
    {U'"', 2, "M0 10 L0 7.4 M2 10 L2 7.4"},
    {U'#', 6.4, "M2.3 10 L1 0 M5.5 10 L4.2 0 M0.5 6.7 L6.4 6.7 M0 3.3 L5.9 3.3"},
    {U'$', 6.2, "A3.1 7.5 2.8 2.5 35 270 A3.1 2.5 3.1 2.5 90 -145 M3.1 11.4 L3.1 -1.4"},
    {U'%', 8, "E1.7 7.9 1.7 2.1 E6.3 2.1 1.7 2.1 M6.6 10 L1.4 0"},
    {U'&', 7.2, "M7.2 0 L1.7 6.7 A3.2 8.1 1.8 1.9 220 -45 L1.2 4.7 A2.9 2.6 2.9 2.6 135 330 L6.9 4.4"},
    {U'\'', 0, "M0 10 L0 7.4"},
    {U'(', 2, "A5.4 4 5.4 8 130 230"},
    {U')', 2, "A-3.4 4 5.4 8 50 -50"},
    {U'*', 3.6, "M1.8 9.8 L1.8 5.8 M0 8.8 L3.6 6.8 M3.6 8.8 L0 6.8"},
    {U'+', 6, "M0 4.4 L6 4.4 M3 1.4 L3 7.4"},
    {U',', 0.6, "M0.6 0.4 L0 -1.7"},
    {U'-', 3.2, "M0 3.8 L3.2 3.8"},
    {U'.', 0, "M0 0.1 L0 0"},
    {U'/', 4.4, "M0 -1.2 L4.4 11"},
    {U'0', 6, "E3 5 3 5"},
    {U'1', 6, "M1 8 L3.7 10 L3.7 0"},
    {U'2', 6, "A3 7.2 2.8 2.8 160 -35 L0.2 0 L6 0"},
    {U'3', 6, "A2.9 7.65 2.5 2.35 150 -90 A2.9 2.65 2.95 2.65 90 -150"},
    {U'4', 6, "M4.6 0 L4.6 10 L0 3 L6.2 3"},
    {U'5', 6, "M5.3 10 L1.1 10 L0.7 5.2 A2.9 3.15 3 3.15 132 -145"},
    {U'6', 6, "E3 3.1 2.9 3.1 M4.6 9.95 A5.2 3.4 5.1 6.6 97 180"},
    {U'7', 6, "M0 10 L6 10 L2 0"},
    {U'8', 6, "E3 7.6 2.4 2.4 E3 2.6 2.9 2.6"},
    {U'9', 6, "E3 6.9 2.9 3.1 M5.9 6.6 A0.8 6.6 5.1 6.6 0 -83"},
    {U':', 0, "M0 0.1 L0 0 M0 6 L0 5.9"},
    {U';', 0.6, "M0.6 0.4 L0 -1.7 M0.5 6 L0.5 5.9"},
    {U'<', 5, "M5 7.4 L0 4.4 L5 1.4"},
    {U'=', 6, "M0 5.7 L6 5.7 M0 3.1 L6 3.1"},
    {U'>', 5, "M0 7.4 L5 4.4 L0 1.4"},
    {U'?', 5, "A2.5 7.5 2.5 2.5 165 -55 L2.5 4.2 L2.5 3 M2.5 0.1 L2.5 0"},
    {U'@', 8.8, "E4.4 4 2 2.3 M6.4 6.2 L6.4 3 A7.5 3 1.1 1.2 180 360 L8.6 4.2 A4.4 4.2 4.2 4.9 0 300"},
    {U'A', 8, "M0 0 L4 10 L8 0 M1.3 3.2 L6.7 3.2"},
    {U'B', 6.6,
     "M0 5.4 L0 0 M0 5.4 L0 10 L3.5 10 A3.5 7.7 2.5 2.3 90 -90 L0 5.4 M3.5 5.4 A3.8 2.7 2.8 2.7 90 -90 L0 0"},
    {U'C', 7.2, "A4.3 5 4.3 5 48 312"},
    {U'D', 7.4, "M0 0 L0 10 L2.6 10 A2.6 5 4.8 5 90 -90 L0 0"},
    {U'E', 5.8, "M5.8 10 L0 10 L0 0 L5.8 0 M0 5.3 L5.1 5.3"},
    {U'F', 5.6, "M5.6 10 L0 10 L0 0 M0 5.1 L4.9 5.1"},
    {U'G', 8.4, "A4.3 5 4.3 5 48 358 L4.9 4.8"},
    {U'H', 7.2, "M0 0 L0 10 M7.2 0 L7.2 10 M0 5.3 L7.2 5.3"},
    {U'I', 3, "M0 10 L3 10 M1.5 10 L1.5 0 M0 0 L3 0"},
    {U'J', 4.6, "M4.6 10 L4.6 2.5 A2.3 2.5 2.3 2.5 0 -165"},
    {U'K', 6.8, "M0 0 L0 10 M6.4 10 L0 3.8 M2.4 6.1 L6.8 0"},
    {U'L', 5.4, "M0 10 L0 0 L5.4 0"},
    {U'M', 9, "M0 0 L0 10 L4.5 2.6 L9 10 L9 0"},
    {U'N', 7.4, "M0 0 L0 10 L7.4 0 L7.4 10"},
    {U'O', 9, "E4.5 5 4.5 5"},
    {U'P', 6.3, "M0 0 L0 10 L3.5 10 A3.5 7.3 2.8 2.7 90 -90 L0 4.6"},
    {U'Q', 9, "E4.5 5 4.5 5 M5.6 2.5 L8.8 -0.8"},
    {U'R', 6.6, "M0 0 L0 10 L3.5 10 A3.5 7.3 2.8 2.7 90 -90 L0 4.6 M3.4 4.6 L6.6 0"},
    {U'S', 6.2, "A3.1 7.55 2.8 2.45 35 270 A3.1 2.55 3.1 2.55 90 -145"},
    {U'T', 7, "M0 10 L7 10 M3.5 10 L3.5 0"},
    {U'U', 7, "M0 10 L0 3.5 A3.5 3.5 3.5 3.5 180 360 L7 10"},
    {U'V', 7.6, "M0 10 L3.8 0 L7.6 10"},
    {U'W', 11, "M0 10 L2.75 0 L5.5 10 L8.25 0 L11 10"},
    {U'X', 7, "M0 10 L7 0 M7 10 L0 0"},
    {U'Y', 7, "M0 10 L3.5 4.8 L7 10 M3.5 4.8 L3.5 0"},
    {U'Z', 6.6, "M0 10 L6.6 10 L0 0 L6.6 0"},
    {U'[', 2, "M2 11 L0 11 L0 -2 L2 -2"},
    {U'\\', 4.4, "M0 11 L4.4 -1.2"},
    {U']', 2, "M0 11 L2 11 L2 -2 L0 -2"},
    {U'^', 4, "M0 7.5 L2 10 L4 7.5"},
    {U'_', 6, "M0 -1.6 L6 -1.6"},
    {U'`', 1.6, "M0 10 L1.6 8.2"},
    {U'a', 5.8, "E2.9 3.5 2.9 3.5 M5.8 7 L5.8 0"},
    {U'b', 5.8, "E2.9 3.5 2.9 3.5 M0 10 L0 0"},
    {U'c', 5, "A2.9 3.5 2.9 3.5 48 312"},
    {U'd', 5.8, "E2.9 3.5 2.9 3.5 M5.8 10 L5.8 0"},
    {U'e', 5.8, "M0 3.6 L5.8 3.6 A2.9 3.5 2.9 3.5 2 312"},
    {U'f', 3.4, "M3.5 9.9 A2.9 8.2 1.8 1.8 70 180 L1.1 0 M0 7 L3.1 7"},
    {U'g', 5.8, "E2.9 3.5 2.9 3.5 M5.8 7 L5.8 -0.4 A2.9 -0.4 2.9 2.6 0 -150"},
    {U'h', 5.2, "M0 10 L0 0 M0 4.4 A2.6 4.4 2.6 2.6 180 0 L5.2 0"},
    {U'i', 0, "M0 7 L0 0 M0 9.7 L0 9.6"},
    {U'j', 1.6, "M1.6 7 L1.6 -1.4 A0 -1.4 1.6 1.6 0 -90 M1.6 9.7 L1.6 9.6"},
    {U'k', 5, "M0 10 L0 0 M4.7 7 L0 2.7 M1.9 4.4 L5 0"},
    {U'l', 1.3, "M0 10 L0 1.4 A1.4 1.4 1.4 1.4 180 265"},
    {U'm', 8.4, "M0 7 L0 0 M0 4.9 A2.1 4.9 2.1 2.1 180 0 L4.2 0 M4.2 4.9 A6.3 4.9 2.1 2.1 180 0 L8.4 0"},
    {U'n', 5.2, "M0 7 L0 0 M0 4.4 A2.6 4.4 2.6 2.6 180 0 L5.2 0"},
    {U'o', 5.8, "E2.9 3.5 2.9 3.5"},
    {U'p', 5.8, "E2.9 3.5 2.9 3.5 M0 7 L0 -3"},
    {U'q', 5.8, "E2.9 3.5 2.9 3.5 M5.8 7 L5.8 -3"},
    {U'r', 3.2, "M0 7 L0 0 M0 4.2 A2.8 4.2 2.8 2.8 180 80"},
    {U's', 4.6, "A2.3 5.25 2.1 1.75 35 270 A2.3 1.75 2.3 1.75 90 -145"},
    {U't', 3.4, "M1.1 9.4 L1.1 1.7 A2.8 1.7 1.7 1.7 180 285 M0 7 L3.2 7"},
    {U'u', 5.2, "M0 7 L0 2.6 A2.6 2.6 2.6 2.6 180 360 M5.2 7 L5.2 0"},
    {U'v', 5.6, "M0 7 L2.8 0 L5.6 7"},
    {U'w', 8.4, "M0 7 L2.1 0 L4.2 7 L6.3 0 L8.4 7"},
    {U'x', 5, "M0 7 L5 0 M5 7 L0 0"},
    {U'y', 5.6, "M0 7 L2.8 0 M5.6 7 L1.6 -3"},
    {U'z', 4.8, "M0 7 L4.8 7 L0 0 L4.8 0"},
    {U'{', 2.4, "M2.4 11 A2.4 9.6 1.5 1.4 90 180 L0.9 6 L0 4.5 L0.9 3 L0.9 -0.6 A2.4 -0.6 1.5 1.4 180 270"},
    {U'|', 0, "M0 11 L0 -2"},
    {U'}', 2.4, "M0 11 A0 9.6 1.5 1.4 90 0 L1.5 6 L2.4 4.5 L1.5 3 L1.5 -0.6 A0 -0.6 1.5 1.4 0 -90"},
    {U'~', 6, "A1.5 4 1.5 1.2 180 0 A4.5 4 1.5 1.2 180 360"},
    {U'°', 2.8, "E1.4 8.6 1.4 1.4"},
    {U'±', 6, "M0 5.4 L6 5.4 M3 2.6 L3 8.2 M0 0.6 L6 0.6"},
    {U'²', 3.4, "A1.7 8.4 1.5 1.6 160 -35 L0 4.6 L3.4 4.6"},
    {U'³', 3.4, "A1.6 8.7 1.4 1.3 150 -90 A1.6 6 1.6 1.4 90 -150"},
    {U'µ', 5.2, "M0 7 L0 -3 M0 2.6 A2.6 2.6 2.6 2.6 180 360 M5.2 7 L5.2 0"},
    {U'μ', 5.2, "M0 7 L0 -3 M0 2.6 A2.6 2.6 2.6 2.6 180 360 M5.2 7 L5.2 0"},
    {U'·', 0, "M0 4.1 L0 4"},
    {U'×', 5, "M0 6.9 L5 1.9 M5 6.9 L0 1.9"},
    {U'Æ', 10, "M0 0 L4.6 10 L10 10 M5.2 10 L5.2 0 L10 0 M1.5 3.2 L5.2 3.2 M5.2 5.3 L9.4 5.3"},
    {U'æ', 10.2, "E2.7 3.5 2.7 3.5 M5.4 7 L5.4 0 M5.4 3.6 L10.2 3.6 A7.8 3.5 2.4 3.5 2 312"},
    {U'Ø', 9, "E4.5 5 4.5 5 M1 -0.6 L8 10.6"},
    {U'ø', 5.8, "E2.9 3.5 2.9 3.5 M0.2 -0.6 L5.6 7.6"},
    {U'ß', 5.4, "M0 0 L0 7.5 A2.4 7.5 2.4 2.5 180 -55 L2.4 5.4 A2.4 2.7 2.9 2.7 80 -115"},
    {U'–', 5, "M0 3.8 L5 3.8"},
    {U'—', 8, "M0 3.8 L8 3.8"},
    {U'−', 6, "M0 4.4 L6 4.4"},
    {U'…', 5, "M0 0.1 L0 0 M2.5 0.1 L2.5 0 M5 0.1 L5 0"},
    {U'→', 7, "M0 4.4 L7 4.4 M4.4 7 L7 4.4 L4.4 1.8"},
};

/// A letter with a mark above it, or below.
struct Marked {
    char32_t character;
    char base, mark;
};
constexpr Marked kMarked[] = {
    {U'À', 'A', '`'},  {U'Á', 'A', '\''}, {U'Â', 'A', '^'},  {U'Ã', 'A', '~'},  {U'Ä', 'A', ':'},  {U'Å', 'A', 'o'},
    {U'Ç', 'C', ','},  {U'È', 'E', '`'},  {U'É', 'E', '\''}, {U'Ê', 'E', '^'},  {U'Ë', 'E', ':'},  {U'Ì', 'I', '`'},
    {U'Í', 'I', '\''}, {U'Î', 'I', '^'},  {U'Ï', 'I', ':'},  {U'Ñ', 'N', '~'},  {U'Ò', 'O', '`'},  {U'Ó', 'O', '\''},
    {U'Ô', 'O', '^'},  {U'Õ', 'O', '~'},  {U'Ö', 'O', ':'},  {U'Ù', 'U', '`'},  {U'Ú', 'U', '\''}, {U'Û', 'U', '^'},
    {U'Ü', 'U', ':'},  {U'Ý', 'Y', '\''}, {U'à', 'a', '`'},  {U'á', 'a', '\''}, {U'â', 'a', '^'},  {U'ã', 'a', '~'},
    {U'ä', 'a', ':'},  {U'å', 'a', 'o'},  {U'ç', 'c', ','},  {U'è', 'e', '`'},  {U'é', 'e', '\''}, {U'ê', 'e', '^'},
    {U'ë', 'e', ':'},  {U'ì', 'i', '`'},  {U'í', 'i', '\''}, {U'î', 'i', '^'},  {U'ï', 'i', ':'},  {U'ñ', 'n', '~'},
    {U'ò', 'o', '`'},  {U'ó', 'o', '\''}, {U'ô', 'o', '^'},  {U'õ', 'o', '~'},  {U'ö', 'o', ':'},  {U'ù', 'u', '`'},
    {U'ú', 'u', '\''}, {U'û', 'u', '^'},  {U'ü', 'u', ':'},  {U'ý', 'y', '\''}, {U'ÿ', 'y', ':'}};

/// Around the middle of a letter, from 0 upward; a cedilla from the baseline down.
const char* pathOfMark(char mark) {
    static constexpr std::pair<char, const char*> kPaths[] = {{'`', "M-1.2 2 L0.6 0.2"},
                                                              {'\'', "M1.2 2 L-0.6 0.2"},
                                                              {'^', "M-1.6 0.2 L0 2 L1.6 0.2"},
                                                              {'~', "A-1 0.8 1 0.9 180 0 A1 0.8 1 0.9 180 360"},
                                                              {':', "M-1.4 1.1 L-1.4 1 M1.4 1.1 L1.4 1"},
                                                              {'o', "E0 1 1.1 1.1"},
                                                              {',', "M0.4 0 L-0.4 -2.2"}};
    return std::ranges::find(kPaths, mark, &std::pair<char, const char*>::first)->second;
}

struct Glyph {
    double width = 0;
    std::vector<Polyline> strokes;
};

std::vector<Polyline> parsed(const char* path, Vec2 shift = Vec2(0)) {
    std::vector<Polyline> strokes;
    const char* const end = path + std::strlen(path);
    const auto number = [&path, end] {
        while (*path == ' ') ++path;
        double value = 0;
        path = std::from_chars(path, end, value).ptr;
        return value;
    };
    const auto arc = [&](bool whole) {
        const double cx = number(), cy = number(), rx = number(), ry = number();
        const double from = whole ? 0 : number(), to = whole ? 360 : number();
        if (strokes.empty() || whole) strokes.emplace_back();
        const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(to - from) / 15)));
        for (int i = 0; i <= steps; ++i) {
            const double angle = (from + (to - from) * i / steps) * std::numbers::pi / 180;
            strokes.back().push_back(shift + Vec2(cx + rx * std::cos(angle), cy + ry * std::sin(angle)));
        }
    };
    while (*path != 0) {
        const char command = *path++;
        if (command == ' ') continue;
        if (command == 'M') strokes.emplace_back();
        if (command == 'M' || command == 'L') {
            const double x = number(), y = number();
            strokes.back().push_back(shift + Vec2(x, y));
        } else {
            arc(command == 'E');
        }
    }
    return strokes;
}

std::map<char32_t, Glyph> makeGlyphs() {
    std::map<char32_t, Glyph> glyphs;
    for (const Drawn& drawn : kGlyphs) glyphs[drawn.character] = {drawn.width, parsed(drawn.path)};
    for (const Marked& marked : kMarked) {
        Glyph glyph = glyphs.at(static_cast<char32_t>(marked.base));
        if (marked.base == 'i') glyph.strokes.pop_back(); // the mark takes the dot's place
        const bool capital = marked.base >= 'A' && marked.base <= 'Z';
        const double above = marked.mark == ',' ? 0 : capital ? 11.2 : 8.4;
        for (Polyline& stroke : parsed(pathOfMark(marked.mark), {glyph.width / 2, above}))
            glyph.strokes.push_back(std::move(stroke));
        glyphs[marked.character] = std::move(glyph);
    }
    glyphs[U' '] = {kBlank, {}};
    glyphs[U'\u00A0'] = {kBlank, {}};
    return glyphs;
}

const Glyph& glyphOf(char32_t character) {
    static const std::map<char32_t, Glyph> s_glyphs = makeGlyphs();
    static const Glyph s_unknown{5, parsed("M0 0 L5 0 L5 10 L0 10 L0 0")};
    const auto known = s_glyphs.find(character);
    return known == s_glyphs.end() ? s_unknown : known->second;
}

/// The character that begins at `text`, which it is taken from. Bytes that are no UTF-8 count as one character each.
char32_t takeCharacter(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    const std::size_t length = first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1;
    char32_t character = length == 1 ? first : first & (0x7Fu >> length);
    bool good = first < 0x80 || (length > 1 && length <= text.size());
    for (std::size_t i = 1; good && i < length; ++i) {
        good = (byte(i) & 0xC0u) == 0x80u;
        character = (character << 6) | (byte(i) & 0x3Fu);
    }
    text.remove_prefix(good ? length : 1);
    return good ? character : U'\uFFFD';
}

} // namespace

std::vector<Polyline> textStrokes(std::string_view utf8) {
    std::vector<Polyline> strokes;
    double x = 0;
    while (!utf8.empty()) {
        const Glyph& glyph = glyphOf(takeCharacter(utf8));
        for (const Polyline& stroke : glyph.strokes) {
            Polyline& placed = strokes.emplace_back(stroke);
            for (Vec2& p : placed) p = (p + Vec2(x, 0)) / kCapital;
        }
        x += glyph.width + kBetween;
    }
    return strokes;
}

double textWidth(std::string_view utf8) {
    double width = 0;
    for (bool first = true; !utf8.empty(); first = false)
        width += glyphOf(takeCharacter(utf8)).width + (first ? 0 : kBetween);
    return width / kCapital;
}

std::string shortenedText(std::string_view utf8, double most) {
    if (textWidth(utf8) <= most) return std::string(utf8);
    std::string shortened;
    for (std::string_view rest = utf8; !rest.empty();) {
        const std::string_view before = rest;
        takeCharacter(rest);
        const std::string longer = shortened + std::string(before.substr(0, before.size() - rest.size()));
        if (textWidth(longer + "…") > most) break;
        shortened = longer;
    }
    return shortened + "…";
}

} // namespace pellucid
