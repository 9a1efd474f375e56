// A report as one HTML file.
#pragma once

#include <span>
#include <string>

#include "report/report.h"

namespace pellucid {

std::string base64(std::span<const unsigned char> bytes); ///< RFC 4648, with padding

/// Self-contained: pictures and curves are inside, nothing is fetched from anywhere. Light, dark, and on paper. Every
/// text is escaped.
std::string htmlOf(const Report& report);

} // namespace pellucid
