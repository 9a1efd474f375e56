// The files that a page is made of, as texts in the program.
#pragma once

#include <string>
#include <vector>

namespace pellucid {

struct PageFile {
    std::string name; ///< below its folder: "page.html"
    std::string text;
};

const std::vector<PageFile>& pageFiles();  ///< src/share/page
const std::vector<PageFile>& rayShaders(); ///< shaders/include

} // namespace pellucid
