#include "volume/formats/data_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "volume/file_names.h"

namespace pellucid {

namespace {

constexpr std::uint64_t kMostFiles = 100'000; ///< a few hundred bytes each

const char* const kPatternToDo = "write PATTERN MIN MAX STEP, with one %d in the pattern for the number";

bool isFile(const TextHeader& header, const std::string& name) {
    std::error_code ec;
    return name.size() <= 1000 && std::filesystem::is_regular_file(header.dataPath(name), ec);
}

/// The number of axes that "2" or "2D" says.
std::int64_t axesIn(const TextHeader& header, std::string word, std::size_t most) {
    std::int64_t axes = 0;
    if (word.ends_with('D')) word.pop_back();
    if (!parseNumber(word, axes) || axes < 1 || axes > static_cast<std::int64_t>(most))
        header.fail("the header divides the data into files of " + inQuotes(word) + " axes, but has " +
                    std::to_string(most));
    return axes;
}

/// How many files have the data of an array of these sizes between them; 0: any number that divides the slowest axis.
std::uint64_t filesNeeded(const TextHeader& header, std::span<const std::int64_t> sizes, std::int64_t axes) {
    const auto slow = sizes.subspan(static_cast<std::size_t>(axes));
    return slow.empty() ? 0 : valueCount(header.path(), slow, 1);
}

/// Sizes of the array in each of `files` files.
std::vector<std::int64_t> shareOf(const TextHeader& header, std::vector<std::int64_t> sizes, std::int64_t axes,
                                  std::uint64_t files) {
    const std::uint64_t needed = filesNeeded(header, sizes, axes);
    if (needed != 0 && files != needed)
        header.fail("the header names " + std::to_string(files) + " data files, but its sizes need " +
                    std::to_string(needed));
    const auto count = static_cast<std::int64_t>(files);
    if (needed == 0 && sizes.back() % count != 0)
        header.fail("the slowest axis of " + std::to_string(sizes.back()) + " cannot be divided among " +
                    std::to_string(files) + " data files");
    if (needed == 0) sizes.back() /= count;
    sizes.resize(static_cast<std::size_t>(axes));
    return sizes;
}

std::int64_t defaultAxes(const std::vector<std::int64_t>& sizes) {
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(sizes.size()) - 1);
}

/// "LIST [AXES]".
DataFiles listedFiles(const TextHeader& header, const std::vector<std::string>& words,
                      const std::vector<std::int64_t>& sizes) {
    if (words.size() > 2) header.fail("there is more than a number of axes behind LIST");
    if (header.listed().empty())
        header.fail("the header lists no data files", "name them behind LIST, one on each line");
    if (header.listed().size() > kMostFiles) header.fail("the header lists too many data files");
    const std::int64_t axes = words.size() == 2 ? axesIn(header, words[1], sizes.size()) : defaultAxes(sizes);
    DataFiles files;
    files.share = shareOf(header, sizes, axes, header.listed().size());
    for (const std::string& name : header.listed()) files.paths.push_back(header.dataPath(name));
    return files;
}

/// The numbers of files: first, first + step, … `count` of them.
struct Numbers {
    std::int64_t first = 0, step = 1;
    std::uint64_t count = 0;
};

/// "MIN MAX STEP", of which the last two may be absent; then there are as many files as are `needed`.
Numbers numbersIn(const TextHeader& header, std::span<const std::int64_t> given, std::uint64_t needed) {
    Numbers numbers{given[0], given.size() > 2 ? given[2] : 1, needed};
    if (given.size() < 2) return numbers;
    constexpr std::int64_t kMost = std::int64_t{1} << 32; // so that differences are numbers, too
    for (const std::int64_t number : given)
        if (number > kMost || number < -kMost) header.fail("the numbers of the data files are too large");
    const std::int64_t difference = given[1] - given[0];
    if (numbers.step == 0 || (difference > 0 && numbers.step < 0) || (difference < 0 && numbers.step > 0))
        header.fail("the numbers of the data files do not lead from " + std::to_string(given[0]) + " to " +
                    std::to_string(given[1]) + " by steps of " + std::to_string(numbers.step));
    numbers.count = static_cast<std::uint64_t>(difference / numbers.step) + 1;
    return numbers;
}

/// "PATTERN MIN MAX STEP [AXES]".
DataFiles numberedFiles(const TextHeader& header, const std::vector<std::string>& words,
                        const std::vector<std::int64_t>& sizes) {
    const std::optional<NumberedName> pattern = numberedName(words[0]);
    if (!pattern) header.fail("the pattern of the data files, " + inQuotes(words[0]) + ", is not known", kPatternToDo);
    std::vector<std::int64_t> given;
    for (std::size_t i = 1; i < words.size() && i < 4; ++i) {
        std::int64_t number = 0;
        if (!parseNumber(words[i], number))
            header.fail("there is " + inQuotes(words[i]) + " for a number of data files");
        given.push_back(number);
    }
    if (words.size() > 5) header.fail("there is too much behind the pattern of the data files", kPatternToDo);
    const std::int64_t axes = words.size() == 5 ? axesIn(header, words[4], sizes.size()) : defaultAxes(sizes);
    const Numbers numbers = numbersIn(header, given, filesNeeded(header, sizes, axes));
    if (numbers.count > kMostFiles) header.fail("the header names too many data files");
    DataFiles files;
    files.share = shareOf(header, sizes, axes, std::max<std::uint64_t>(1, numbers.count));
    for (std::uint64_t n = 0; n < std::max<std::uint64_t>(1, numbers.count); ++n)
        files.paths.push_back(
            header.dataPath(pattern->with(numbers.first + static_cast<std::int64_t>(n) * numbers.step)));
    return files;
}

/// Whether these words are a pattern and at least one number.
bool isPattern(const std::vector<std::string>& words) {
    const auto isNumber = [](const std::string& word) {
        std::int64_t number = 0;
        return parseNumber(word, number);
    };
    return words.size() > 1 && words[0].find('%') != std::string::npos && isNumber(words[1]);
}

} // namespace

bool isListOfFiles(const TextHeader& header, const std::string& name) {
    const std::string field = header.get(name);
    const std::vector<std::string> words = splitWords(field);
    return !words.empty() && words[0] == "LIST" && !isFile(header, field);
}

DataFiles dataFilesIn(const TextHeader& header, const std::string& name,
                      const std::function<std::vector<std::int64_t>()>& sizes) {
    const std::string field = header.get(name);
    const std::vector<std::string> words = splitWords(field);
    if (words.empty() || isFile(header, field)) return {{header.dataPath(field)}, {}};
    if (words[0] == "LIST") return listedFiles(header, words, sizes());
    if (words[0] == "SKIPLIST")
        header.fail("a list of data files with bytes to skip in each is not supported",
                    "write it with LIST and byte skip, or as one file");
    return isPattern(words) ? numberedFiles(header, words, sizes()) : DataFiles{{header.dataPath(field)}, {}};
}

void placeParts(FileLayout& layout, const std::vector<std::string>& files, const std::vector<std::int64_t>& share,
                int step, const std::function<void(FileLayout& part)>& place) {
    FileLayout part;
    for (const std::int64_t size : share)
        part.axes.push_back({size, true}); // no axis of steps: it is checked as a whole
    const std::uint64_t each = valuesIn(part, layout.dataPath), last = valuesUpTo(layout, step);
    std::uint64_t first = step > 0 ? valuesUpTo(layout, step - 1) : 0;
    if (first == last) first = 0; // steps lie between each other
    for (std::size_t n = 0; n < files.size(); ++n) {
        static_cast<StoredValues&>(part) = layout;
        part.dataPath = files[n];
        part.notices.clear();
        if (n * each < last && (n + 1) * each > first) place(part);
        layout.parts.push_back(part);
        for (const std::string& notice : part.notices) // once, where all files have it
            if (std::ranges::find(layout.notices, notice) == layout.notices.end()) layout.notices.push_back(notice);
    }
}

} // namespace pellucid
