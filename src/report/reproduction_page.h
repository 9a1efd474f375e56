// Reproductions for readers: a page to look at, and the index of the documentation.
#pragma once

#include <span>
#include <string>

#include "report/reproduction.h"

namespace pellucid {

struct ReproductionPage {
    std::span<const Reproduction> items; ///< in the order of the page
    std::string program;                 ///< and its version
    std::string command;                 ///< what made the page, as typed into a shell
    double seconds = 0;                  ///< that it took
};

/// One HTML file that lies in the folder of the pictures: contents, then each item with its pictures, numbers beside
/// the thesis's, statements, commands and time. Light, dark, and on paper. Every text is escaped.
std::string htmlOf(const ReproductionPage& page);

/// Markdown: equations with the files and items that have them, then each item without its pictures and times, so that
/// the same data give the same text.
std::string indexOf(std::span<const Reproduction> items);

} // namespace pellucid
