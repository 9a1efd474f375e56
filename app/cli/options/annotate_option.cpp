#include "options/annotate_option.h"

#include "parse.h"

namespace pellucid::cli {

namespace {

/// "cube,scale" or "all".
AnnotationChoice parseParts(const std::string& text, const std::string& option) {
    AnnotationChoice show = AnnotationChoice::none();
    for (const std::string& word : split(text, ',')) {
        bool known = false;
        for (const AnnotationPartInfo& part : kAnnotationParts)
            if (word == part.name || word == "all") known = show.*part.shown = true;
        if (!known)
            throw UsageError(
                "'" + text + "' does not name annotations", option,
                "give all, or some of cube, letters, axes, scale, legend, title, measures with commas between");
    }
    return show;
}

} // namespace

void addAnnotate(CLI::App& app, AnnotationChoice& show, const std::string& help) {
    addValue(app, "--annotate", "PARTS", show, parseParts, help);
}

} // namespace pellucid::cli
