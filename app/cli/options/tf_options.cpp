#include "options/tf_options.h"

#include "parse.h"

namespace pellucid::cli {

void TfOptions::add(CLI::App& app) {
    addValue(
        app, "--tf", "FILE|tents:N[:PEAK]|ramp:N|preset:NAME",
        [this](const std::string& text, const std::string& option) {
            if (text.empty()) throw UsageError("the name is empty", option, "give a file, tents:N[:PEAK] or ramp:N");
            spec = text;
        },
        "transfer function (default: the session's, else the sample's own, else tents:3); the \"range\" of a file "
        "becomes the window unless --range says otherwise, and its points stay at their data values whatever the "
        "window",
        "Volume");
}

} // namespace pellucid::cli
