// A report as one HTML file.
#pragma once

#include <string>

#include "report/report.h"

namespace pellucid {

/// Self-contained: pictures and curves are inside, nothing is fetched from anywhere. Light, dark, and on paper. Every
/// text is escaped.
std::string htmlOf(const Report& report);

} // namespace pellucid
