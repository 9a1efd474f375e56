// Headers that are texts: fields by name, and what the readers of formats ask of them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "volume/formats/file_check.h"

namespace pellucid {

/// The fields of one file's header. Whatever is wrong with one is a FileError that names the file.
class TextHeader {
public:
    /// Hands the lines of the file, trimmed, to `take` until that returns false: it was the last one of the header.
    TextHeader(const std::string& path, const std::function<bool(TextHeader&, const std::string& line)>& take);

    const std::string& path() const noexcept { return m_path; }
    std::uint64_t dataStart() const noexcept { return m_dataStart; } ///< the first byte behind the header

    void set(const std::string& name, std::string value) { m_fields[name] = std::move(value); }
    bool has(const std::string& name) const { return m_fields.contains(name); }
    std::string get(const std::string& name) const; ///< empty where there is no such field

    std::int64_t wholeNumber(const std::string& name, std::int64_t otherwise) const;
    /// The sizes of 1 to `mostAxes` axes, as many as the field `dimension` says.
    std::vector<std::int64_t> sizes(const std::string& name, const std::string& dimension, std::int64_t mostAxes) const;
    /// Names of files that stand behind the fields, one on each line.
    void addListed(std::string name) { m_listed.push_back(std::move(name)); }
    const std::vector<std::string>& listed() const noexcept { return m_listed; }
    /// The file that the header calls `file`, relative to its own folder.
    std::string dataPath(const std::string& file) const;

    [[noreturn]] void fail(const std::string& what, const std::string& toDo = "correct the header") const;

private:
    std::string m_path;
    std::map<std::string, std::string> m_fields;
    std::vector<std::string> m_listed;
    std::uint64_t m_dataStart = 0;
};

/// The number that a word is; NaN where it is none.
double numberIn(const std::string& word);

/// The blank-separated numbers of `text`, which the file `path` calls `what`. Throws FileError unless all are finite.
std::vector<double> finiteNumbers(const std::string& text, const std::string& what, const std::string& path);

/// Throws FileError unless `spacing`, which the header gives as `text`, is a distance between voxels.
void requireSpacing(double spacing, std::size_t axis, const std::string& text, const std::string& path);

} // namespace pellucid
