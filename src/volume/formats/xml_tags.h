// The tags of an XML file, one after the other; the data between them, perhaps gigabytes, are skipped.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "volume/formats/byte_source.h"

namespace pellucid {

/// `text` with &amp; and the like replaced; what is no entity stays as it is.
std::string withoutEntities(const std::string& text);

/// One tag.
struct XmlTag {
    std::string name;
    std::map<std::string, std::string> attributes; ///< entities replaced
    bool opens = true, closes = false;             ///< both: "<a/>"
    std::uint64_t end = 0;                         ///< the byte of the file behind its ">"

    /// Empty where there is none.
    std::string get(const std::string& attribute) const;
};

/// Skips comments, instructions and what stands between tags. A tag is shorter than 64 KiB.
class XmlTags {
public:
    XmlTags(const std::string& path, const JobControl& job) : m_path(path), m_text(path, 0, job) {}
    /// The next tag; false at the end of the file. Throws FileError where a tag cannot be read.
    bool next(XmlTag& tag);

private:
    bool passOver(const std::string& end);
    [[noreturn]] void fail(const std::string& what) const;
    std::optional<std::string> tagText();
    XmlTag parsed(const std::string& text) const;

    std::string m_path;
    FileCharacters m_text;
};

} // namespace pellucid
