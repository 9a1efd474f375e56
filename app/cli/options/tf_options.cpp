#include "options/tf_options.h"

#include "parse.h"

namespace pellucid::cli {

void TfOptions::add(CLI::App& app) {
    addValue(
        app, "--tf", "FILE|auto|tents:N[:PEAK]|ramp:N",
        [this](const std::string& text, const std::string& option) {
            if (text.empty()) throw UsageError("the name is empty", option, "give a file, auto, tents:N[:PEAK] or ramp:N");
            spec = text;
        },
        "transfer function (default: the session's, else auto: what the data propose, see propose); auto and the "
        "\"range\" of a file set the window unless --range says otherwise; points stay at their data values whatever "
        "the window",
        "Volume");
}

} // namespace pellucid::cli
