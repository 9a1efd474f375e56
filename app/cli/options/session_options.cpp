#include "options/session_options.h"

#include "parse.h"

namespace pellucid::cli {

void SessionOptions::add(CLI::App& app) {
    addValue(
        app, "--session", "FILE",
        [this](const std::string& text, const std::string& option) {
            if (text.empty()) throw UsageError("the file name is empty", option, "name a session, *.pellucid.json");
            file = text;
        },
        "everything as in this saved session; VOLUME and options override it", "Volume");
}

SessionFile SessionOptions::read() const { return file ? readSession(*file) : SessionFile{}; }

} // namespace pellucid::cli
