// The files that hold the data of a header: one, or several with the same share each.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "volume/formats/samples.h"
#include "volume/formats/text_header.h"

namespace pellucid {

/// Files in the order of the data.
struct DataFiles {
    std::vector<std::string> paths;
    std::vector<std::int64_t> share; ///< sizes of the array in each of several; empty: there is one file, which has all
};

/// Whether the lines behind the field `name` of a header are names of files: it says "LIST", and no file is called so.
bool isListOfFiles(const TextHeader& header, const std::string& name);

/// The files that the field `name` names: one; with "LIST [AXES]" those of header.listed(); with "PATTERN MIN [MAX
/// [STEP [AXES]]]" those whose number stands for the "%d" of the pattern. AXES: how many axes of the whole the array in
/// each file has, one less than the whole where nothing is said; with all of them, the slowest one is divided. A name
/// that a file has is no pattern. `sizes` tells those of the whole, where there are several. Throws FileError.
DataFiles dataFilesIn(const TextHeader& header, const std::string& name,
                      const std::function<std::vector<std::int64_t>()>& sizes);

/// Fills layout.parts: each of `files` has the values of an array of the sizes `share`. For those that have values of
/// `step`, place(part) checks the file and tells where in it they begin.
void placeParts(FileLayout& layout, const std::vector<std::string>& files, const std::vector<std::int64_t>& share,
                int step, const std::function<void(FileLayout& part)>& place);

} // namespace pellucid
