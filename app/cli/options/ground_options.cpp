#include "options/ground_options.h"

#include "parse.h"
#include "tf/terrain.h"

namespace pellucid::cli {

namespace {

constexpr const char* kGroundGroup = "Ground";

/// "NX,NY,TYPE[,ENDIAN]".
RawLayout parseGroundLayout(const std::string& text, const std::string& option) {
    std::vector<std::string> parts = split(text, ',');
    if (parts.size() < 3 || parts.size() > 4)
        throw UsageError("'" + text + "' is not a layout of heights", option,
                         "give NX,NY,TYPE[,little|big], TYPE one of u8 i8 u16 i16 u32 i32 f32 f64");
    parts.insert(parts.begin() + 2, "1");
    return atOption(option + " " + text, [&] { return parseRawLayout(joined(parts, ",")); });
}

} // namespace

void GroundOptions::add(CLI::App& app) {
    addValue(
        app, "--ground", "FILE|none",
        [this](const std::string& text, const std::string& option) {
            if (text.empty()) throw UsageError("the name of the ground is empty", option, "name a file or sample");
            path = text;
        },
        "a height field under the volume, over its whole box along x and y: a volume file of one layer, or "
        "sample:hurricane/ground; none: not that of the session",
        kGroundGroup);
    addValue(app, "--ground-raw", "NX,NY,TYPE[,ENDIAN]", raw, parseGroundLayout,
             "the file of the ground is headerless, see --raw", kGroundGroup);
    given.add(app, kGroundGroup);
}

void GroundOptions::applyTo(SceneInputs& inputs) const {
    Part<GroundView>& ground = inputs.session.ground;
    if (path == "none") {
        ground = GroundView{};
    } else if (path) {
        GroundView named;
        named.path = *path;
        ground = named;
    }
    if (!raw && given.given().empty()) return;
    const std::string detail = raw ? "--ground-raw" : given.given().front()->optionName();
    if (ground->path.empty()) throw UsageError("there is no ground", detail, "add --ground FILE");
    if (raw && ground->path.starts_with("sample:"))
        throw UsageError("a built-in sample has no headerless file", "--ground-raw", "leave it out");
    ground.edit([&](GroundView& view) {
        if (raw) view.raw = raw;
        given.applyTo(view);
        view.shown = true;
    });
}

} // namespace pellucid::cli
