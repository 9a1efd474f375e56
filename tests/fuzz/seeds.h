// The inputs that fuzzing begins with.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace pellucid::fuzz {

/// Formats whose bytes are no words.
inline const std::set<std::string> kBinary{"nifti", "nifti_gz", "inflate", "bzip2", "dicom_stack"};
/// Values that are at the end of what numbers hold, or none.
inline const std::vector<std::string> kOddWords{
    "-1",  "0",  "2147483647", "2147483648", "9223372036854775807", "18446744073709551616", "1e-320", "1e999", "nan",
    "inf", "..", "/",          "%d"};

/// Of letters, digits and underscores, from a letter on.
inline std::set<std::string> wordsIn(const std::string& text) {
    std::set<std::string> words;
    const std::regex word("[A-Za-z][A-Za-z0-9_]{2,30}");
    for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at) words.insert(at->str());
    return words;
}

/// Where seeds go, each under the next number.
class Seeds {
public:
    explicit Seeds(std::string folder) : m_folder(std::move(folder)) {}
    void add(const std::string& target, const std::string& bytes) {
        const std::filesystem::path folder = m_folder / target;
        std::filesystem::create_directories(folder);
        std::ofstream(folder / std::to_string(m_counts[target]++), std::ios::binary) << bytes;
        if (!kBinary.contains(target)) m_words[target].merge(wordsIn(bytes));
    }
    void writeDictionaries() const {
        for (const auto& [target, words] : m_words) {
            std::ofstream out(m_folder / (target + ".dict"));
            for (const std::string& word : words) out << '"' << word << "\"\n";
            for (const std::string& word : kOddWords) out << '"' << word << "\"\n";
        }
    }

private:
    std::filesystem::path m_folder;
    std::map<std::string, int> m_counts;
    std::map<std::string, std::set<std::string>> m_words;
};

inline std::string bytesIn(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// main() of a program that takes the name of a folder and writes seeds into it, FOLDER/TARGET/NUMBER, and
/// FOLDER/TARGET.dict with the words of those that are texts.
template <class Add>
int writeSeeds(int argc, char** argv, const Add& add) {
    if (argc != 2) {
        std::fprintf(stderr, "%s FOLDER\n", argv[0]);
        return 2;
    }
    Seeds seeds(argv[1]);
    add(seeds);
    seeds.writeDictionaries();
    return 0;
}

} // namespace pellucid::fuzz
