// --annotate: what stands around a picture.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "render/annotation.h"

namespace pellucid::cli {

/// `show` outlives the parsing.
void addAnnotate(CLI::App& app, AnnotationChoice& show, const std::string& help);

} // namespace pellucid::cli
