#include "volume/file_names.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <span>

#include "base/text.h"

namespace pellucid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDigits = 15; // of a number that counts

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// The end of the digits that begin at `at`.
std::size_t digitsEnd(const std::string& text, std::size_t at) {
    while (at < text.size() && isDigit(text[at])) ++at;
    return at;
}

/// Names of what is in a folder; "" is the present one.
std::vector<std::string> namesIn(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code ec;
    fs::directory_iterator entry(folder.empty() ? fs::path(".") : fs::path(folder), ec);
    for (; !ec && entry != fs::directory_iterator(); entry.increment(ec))
        names.push_back(entry->path().filename().string());
    return names;
}

bool isFile(const std::string& path) {
    std::error_code ec;
    return fs::is_regular_file(path, ec);
}

/// The part of a path that ends with its last slash before `at`, and where the next one is.
struct Component {
    std::string folder;
    std::size_t begin = 0, end = 0;
};
Component componentAt(const std::string& path, std::size_t at) {
    const std::size_t slash = at == 0 ? std::string::npos : path.rfind('/', at - 1);
    Component c;
    c.begin = slash == std::string::npos ? 0 : slash + 1;
    c.end = std::min(path.find('/', at), path.size());
    c.folder = path.substr(0, c.begin);
    return c;
}

/// Whether the characters from `at` of a set "[…]" hold `c`; `at` becomes the place behind it. No set: at stays.
bool setHolds(const std::string& pattern, std::size_t& at, char c) {
    std::size_t i = at + 1;
    const bool none = i < pattern.size() && (pattern[i] == '!' || pattern[i] == '^');
    if (none) ++i;
    bool holds = false;
    for (const std::size_t first = i; i < pattern.size() && (pattern[i] != ']' || i == first); ++i) {
        char lo = pattern[i], hi = lo;
        if (i + 2 < pattern.size() && pattern[i + 1] == '-' && pattern[i + 2] != ']') {
            hi = pattern[i + 2];
            i += 2;
        }
        holds = holds || (lo <= c && c <= hi);
    }
    if (i >= pattern.size()) return false; // not closed: a bracket
    at = i + 1;
    return holds != none;
}

void expand(const std::string& glob, std::size_t from, std::vector<std::string>& found) {
    const std::size_t wild = glob.find_first_of("*?[", from);
    if (wild == std::string::npos) {
        if (isFile(glob)) found.push_back(glob);
        return;
    }
    const Component c = componentAt(glob, wild);
    const std::string pattern = glob.substr(c.begin, c.end - c.begin);
    for (const std::string& name : namesIn(c.folder)) {
        if ((name.starts_with('.') && !pattern.starts_with('.')) || !matchesGlob(pattern, name)) continue;
        const std::string path = c.folder + name + glob.substr(c.end);
        if (c.end == glob.size()) {
            if (isFile(path)) found.push_back(path);
        } else {
            expand(path, c.folder.size() + name.size(), found);
        }
    }
}

} // namespace

std::string NumberedName::with(std::int64_t number) const {
    std::string digits = std::to_string(number);
    if (digits.size() < static_cast<std::size_t>(width))
        digits.insert(0, static_cast<std::size_t>(width) - digits.size(), zeros ? '0' : ' ');
    return before + digits + after;
}

std::optional<NumberedName> numberedName(const std::string& path) {
    NumberedName name;
    bool found = false;
    for (std::size_t i = 0; i < path.size(); ++i) {
        std::string& part = found ? name.after : name.before;
        if (path[i] != '%') {
            part += path[i];
            continue;
        }
        if (i + 1 < path.size() && path[i + 1] == '%') {
            part += path[++i];
            continue;
        }
        std::size_t end = digitsEnd(path, i + 1);
        const std::string width = path.substr(i + 1, end - i - 1);
        if (found || end >= path.size() || std::string_view("diu").find(path[end]) == std::string_view::npos ||
            width.size() > 2)
            return {};
        name.zeros = width.starts_with('0');
        name.width = width.empty() ? 0 : std::stoi(width);
        found = true;
        i = end;
    }
    if (!found) return {};
    return name;
}

std::string pathOfUrl(const std::string& text) {
    constexpr std::string_view kScheme = "file://", kHost = "localhost", kShort = "file:"; // file:/a is file:///a
    if (text.starts_with("file:/") && !text.starts_with(kScheme)) return percentDecoded(text.substr(kShort.size()));
    if (!text.starts_with(kScheme)) return text;
    std::string_view rest = std::string_view(text).substr(kScheme.size());
    if (rest.starts_with(kHost)) rest.remove_prefix(kHost.size());
    return percentDecoded(rest);
}

bool isGlob(const std::string& path) { return path.find_first_of("*?[") != std::string::npos; }

bool matchesGlob(const std::string& pattern, const std::string& name) {
    // Where there was a star last, it may take one character more.
    std::size_t p = 0, n = 0, star = std::string::npos, taken = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            taken = n;
            continue;
        }
        std::size_t next = p + 1;
        bool same = p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n]);
        if (p < pattern.size() && pattern[p] == '[') {
            std::size_t behind = p;
            const bool holds = setHolds(pattern, behind, name[n]);
            if (behind != p) {
                next = behind;
                same = holds;
            }
        }
        if (same) {
            p = next;
            ++n;
        } else if (star != std::string::npos) {
            p = star + 1;
            n = ++taken;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

std::vector<std::string> filesNumbered(const NumberedName& pattern) {
    const Component c = componentAt(pattern.before + pattern.after, pattern.before.size());
    const std::string before = pattern.before.substr(c.begin);
    const std::string after = pattern.after.substr(0, std::min(pattern.after.find('/'), pattern.after.size()));
    std::vector<std::string> found;
    for (const std::string& name : namesIn(c.folder)) {
        if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
            continue;
        const std::string digits = trimmed(name.substr(before.size(), name.size() - before.size() - after.size()));
        std::int64_t number = 0;
        if (digits.size() > kMostDigits || digitsEnd(digits, 0) != digits.size() || !parseNumber(digits, number))
            continue;
        const std::string path = pattern.with(number);
        if (path.substr(c.begin, name.size()) == name && isFile(path)) found.push_back(path);
    }
    return found;
}

std::vector<std::string> filesMatching(const std::string& glob) {
    std::vector<std::string> found;
    expand(glob, 0, found);
    return found;
}

std::vector<std::string> filesIn(const std::string& folder) {
    std::vector<std::string> found;
    for (const std::string& name : namesIn(folder)) {
        std::string path = (fs::path(folder) / name).string();
        if (!name.starts_with('.') && isFile(path)) found.push_back(std::move(path));
    }
    return found;
}

bool anyFileBelow(const std::string& folder, const std::function<bool(const fs::directory_entry&)>& found) {
    constexpr int kMostFolders = 8;
    std::error_code ec;
    for (auto it = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, ec);
         !ec && it != fs::recursive_directory_iterator(); it.increment(ec)) {
        if (it.depth() >= kMostFolders) it.disable_recursion_pending();
        if (it->is_regular_file(ec) && found(*it)) return true;
    }
    return false;
}

std::optional<NumberedNames> numberedBy(const NumberedName& name, const std::vector<std::string>& paths) {
    NumberedNames names{name, {}};
    for (const std::string& path : paths) {
        const std::size_t length = path.size() - name.before.size() - name.after.size();
        std::int64_t number = 0;
        if (!parseNumber(trimmed(path.substr(name.before.size(), length)), number)) return {};
        names.numbers.push_back(number);
    }
    return names;
}

std::optional<NumberedNames> numberedNames(const std::vector<std::string>& paths) {
    if (paths.size() < 2) return {};
    // Up to the first difference the first and the last are the same, and so are all between; then the digits begin.
    const std::string &one = paths.front(), &other = paths.back();
    std::size_t begin = 0;
    while (begin < one.size() && begin < other.size() && one[begin] == other[begin]) ++begin;
    while (begin > 0 && isDigit(one[begin - 1])) --begin;
    NumberedName name;
    name.before = one.substr(0, begin);
    name.after = one.substr(digitsEnd(one, begin));
    if (one.size() == begin + name.after.size()) return {}; // no digits
    const auto digitsOf = [&](const std::string& path) { return path.size() - name.before.size() - name.after.size(); };
    name.width = static_cast<int>(digitsOf(one));
    NumberedNames names{name, {}};
    for (const std::string& path : paths) {
        std::int64_t number = 0;
        if (path.size() <= begin + name.after.size() || digitsOf(path) > kMostDigits ||
            digitsEnd(path, begin) != begin + digitsOf(path) ||
            !parseNumber(path.substr(begin, digitsOf(path)), number) || name.with(number) != path)
            return {}; // another name, or zeros here and none there
        names.numbers.push_back(number);
    }
    return names;
}

std::optional<NumberGaps> gapsIn(const std::vector<std::int64_t>& numbers) {
    if (numbers.size() < 3) return {};
    std::map<std::int64_t, int> steps;
    for (std::size_t i = 1; i < numbers.size(); ++i) ++steps[numbers[i] - numbers[i - 1]];
    const auto usual =
        std::max_element(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    NumberGaps gaps{usual->first, 0};
    if (gaps.step < 1 || steps.size() == 1) return {};
    for (const auto& [difference, count] : steps) {
        if (difference % gaps.step != 0) return {}; // no even course
        gaps.missing += static_cast<std::uint64_t>(difference / gaps.step - 1) * static_cast<std::uint64_t>(count);
    }
    return gaps;
}

std::string someNames(const std::vector<std::string>& paths) {
    constexpr std::size_t kShown = 4;
    const std::string text = joined(std::span(paths).first(std::min(paths.size(), kShown)), ", ",
                                    [](const std::string& path) { return fs::path(path).filename().string(); });
    return paths.size() <= kShown ? text : text + " and " + std::to_string(paths.size() - kShown) + " more";
}

std::string volumeSuffix(const std::string& path) {
    const std::string name = lowerCase(fs::path(path).filename().string());
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0) return {};
    const std::string suffix = name.substr(dot);
    if (suffix != ".gz") return suffix;
    const std::size_t before = name.rfind('.', dot - 1);
    return before == std::string::npos || before == 0 ? suffix : name.substr(before);
}

bool countsBefore(const std::string& a, const std::string& b) {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (isDigit(a[i]) && isDigit(b[j])) {
            const std::size_t endA = digitsEnd(a, i), endB = digitsEnd(b, j);
            std::size_t x = i, y = j;
            while (x + 1 < endA && a[x] == '0') ++x;
            while (y + 1 < endB && b[y] == '0') ++y;
            if (endA - x != endB - y) return endA - x < endB - y;
            if (const int order = a.compare(x, endA - x, b, y, endB - y); order != 0) return order < 0;
            i = endA;
            j = endB;
        } else {
            if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
            ++i;
            ++j;
        }
    }
    if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
    return a < b; // "f01" before "f1"
}

} // namespace pellucid
