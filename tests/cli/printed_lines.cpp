#include "printed_lines.h"

#include <cmath>
#include <fstream>
#include <sstream>

namespace pellucid::test {

const std::regex kTime("[0-9]+(\\.[0-9]+)? (s|ms|µs)(?![A-Za-z])");

Lines linesOf(const std::string& text) {
    std::istringstream in(text);
    Lines lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::string textOf(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::string timeless(const std::string& line) { return std::regex_replace(line, kTime, "TIME"); }

bool sameLine(const std::string& shown, const std::string& printed) {
    static const std::regex kDecimal("[0-9]+\\.[0-9]+");
    const std::string a = timeless(shown), b = timeless(printed);
    const std::sregex_iterator end;
    std::sregex_iterator i(a.begin(), a.end(), kDecimal), j(b.begin(), b.end(), kDecimal);
    std::size_t fromA = 0, fromB = 0; // behind the number before
    for (; i != end && j != end; ++i, ++j) {
        const auto atA = static_cast<std::size_t>(i->position()), atB = static_cast<std::size_t>(j->position());
        if (a.substr(fromA, atA - fromA) != b.substr(fromB, atB - fromB)) return false;
        const auto decimals = [](const std::string& number) { return number.size() - number.find('.') - 1; };
        const double digit = std::pow(10.0, -static_cast<double>(std::max(decimals(i->str()), decimals(j->str()))));
        if (std::abs(std::stod(i->str()) - std::stod(j->str())) > 1.5 * digit) return false;
        fromA = atA + static_cast<std::size_t>(i->length());
        fromB = atB + static_cast<std::size_t>(j->length());
    }
    return i == end && j == end && a.substr(fromA) == b.substr(fromB);
}

} // namespace pellucid::test
