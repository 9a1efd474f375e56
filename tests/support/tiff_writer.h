// Writes TIFF files, as TIFF 6.0 describes them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::test {

struct TiffPage {
    int width = 3, height = 2, bits = 16, samples = 1;
    int compression = 1;     ///< 1: none; 8: deflate, pixels are packed then
    int format = 1;          ///< 1: unsigned, 2: signed, 3: floats
    std::string pixels;      ///< bytes, little endian
    std::string description; ///< ImageDescription; empty: none
    int pixelsPerUnit = 0;   ///< XResolution and YResolution; 0: none
    int photometric = -1;    ///< PhotometricInterpretation, 0 is WhiteIsZero; -1: as the samples are
    int orientation = 0;     ///< 0: no such tag
    int depth = 0;           ///< ImageDepth; 0: no such tag
};

/// How the pages of a file are written.
struct TiffForm {
    bool bigEndian = false;      ///< pixels are written as they are
    bool pixelsTogether = false; ///< those of all pages before the first directory
    int rowsPerStrip = 0;        ///< 0: one strip a page
    bool oneDirectory = false;   ///< that of the first page alone, as ImageJ writes large stacks
};

inline std::string tiffFile(const std::vector<TiffPage>& pages, const TiffForm& form = {}) {
    const auto number = [&](std::uint64_t value, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i)
            text += static_cast<char>(value >> (8 * (form.bigEndian ? bytes - 1 - i : i)) & 255);
        return text;
    };
    // Short values stand at the left of an entry's four bytes; two of them are the same here.
    const auto valueOf = [&](int type, std::uint64_t count, std::uint64_t value) {
        return type == 3 && count <= 2 ? number(value, 2) + number(count == 2 ? value : 0, 2) : number(value, 4);
    };
    std::string file = (form.bigEndian ? std::string("MM\0*", 4) : std::string("II*\0", 4)) + number(0, 4);
    std::size_t link = 4;           // where the next directory's place is to be written
    std::size_t next = file.size(); // the next page's pixels, where they stand together
    for (const TiffPage& page : pages)
        if (form.pixelsTogether) file += page.pixels;
    if (file.size() % 2 != 0) file += '\0';
    for (const TiffPage& page : pages) {
        struct Entry {
            int tag, type;
            std::uint64_t count, value;
        };
        std::vector<Entry> entries;
        const auto put = [&](const std::string& bytes) {
            const std::size_t at = file.size();
            file += bytes;
            if (file.size() % 2 != 0) file += '\0';
            return at;
        };
        const std::size_t pixels = form.pixelsTogether ? next : put(page.pixels);
        next += page.pixels.size();
        const auto height = static_cast<std::size_t>(page.height);
        const std::size_t rows = form.rowsPerStrip > 0 ? static_cast<std::size_t>(form.rowsPerStrip) : height;
        const std::size_t strips = (height - 1) / rows + 1;
        std::string starts, lengths;
        for (std::size_t row = 0; row < height; row += rows) {
            const auto before = [&](std::size_t end) { return page.pixels.size() * std::min(end, height) / height; };
            starts += number(pixels + before(row), 4);
            lengths += number(before(row + rows) - before(row), 4);
        }
        entries.push_back({256, 4, 1, static_cast<std::uint64_t>(page.width)});
        entries.push_back({257, 4, 1, static_cast<std::uint64_t>(page.height)});
        std::string bits;
        for (int s = 0; s < page.samples; ++s) bits += number(static_cast<std::uint64_t>(page.bits), 2);
        entries.push_back({258, 3, static_cast<std::uint64_t>(page.samples),
                           page.samples > 2 ? put(bits) : static_cast<std::uint64_t>(page.bits)});
        entries.push_back({259, 3, 1, static_cast<std::uint64_t>(page.compression)});
        entries.push_back({262, 3, 1,
                           static_cast<std::uint64_t>(page.photometric >= 0 ? page.photometric
                                                      : page.samples >= 3   ? 2
                                                                            : 1)});
        if (!page.description.empty())
            entries.push_back({270, 2, page.description.size() + 1, put(page.description + '\0')});
        entries.push_back({273, 4, strips, strips > 1 ? put(starts) : pixels});
        if (page.orientation > 0) entries.push_back({274, 3, 1, static_cast<std::uint64_t>(page.orientation)});
        entries.push_back({277, 3, 1, static_cast<std::uint64_t>(page.samples)});
        entries.push_back({278, 4, 1, rows});
        entries.push_back({279, 4, strips, strips > 1 ? put(lengths) : page.pixels.size()});
        if (page.pixelsPerUnit > 0)
            for (const int tag : {282, 283})
                entries.push_back(
                    {tag, 5, 1, put(number(static_cast<std::uint64_t>(page.pixelsPerUnit), 4) + number(1, 4))});
        entries.push_back({339, 3, 1, static_cast<std::uint64_t>(page.format)});
        if (page.depth > 0) entries.push_back({32997, 4, 1, static_cast<std::uint64_t>(page.depth)});
        const std::size_t directory = file.size();
        file.replace(link, 4, number(directory, 4));
        file += number(entries.size(), 2);
        for (const Entry& entry : entries)
            file += number(static_cast<std::uint64_t>(entry.tag), 2) +
                    number(static_cast<std::uint64_t>(entry.type), 2) + number(entry.count, 4) +
                    valueOf(entry.type, entry.count, entry.value);
        link = file.size();
        file += number(0, 4);
        if (form.oneDirectory) break;
    }
    return file;
}

} // namespace pellucid::test
