// Presets of vtk.js: as those of ParaView, but for colours alone.
#include <nlohmann/json.hpp>

#include "tf/formats/foreign_file.h"
#include "tf/formats/paraview_preset.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

using nlohmann::json;

namespace {

/// ParaView's reader takes them: a list of presets, with RGBPoints.
bool knowsNothingOfItsOwn(const ForeignFile&) { return false; }

ReadTf readVtkJs(const ForeignFile& file) { return paraViewFormat().read(file); }

std::vector<std::string> namesIn(const ForeignFile& file) { return paraViewFormat().names(file); }

WrittenTf writeVtkJs(const TfToWrite& tf) {
    json preset = presetOfPoints(tf.pointsApart({}), tf.range(), tf.name());
    for (const char* key : {"Points", "Creator", "NanColor"}) preset.erase(key);
    WrittenTf written;
    written.text = json::array({std::move(preset)}).dump(1, ' ', false, json::error_handler_t::replace) + "\n";
    written.losses.emplace_back("opacities are not stored: this format has colours only");
    return written;
}

} // namespace

TfFormat vtkJsFormat() {
    return {"vtkjs",
            "vtk.js preset",
            "a preset of vtk.js",
            ".vtkjs.json",
            true,
            "opacities, features",
            &knowsNothingOfItsOwn,
            &readVtkJs,
            &writeVtkJs,
            &namesIn};
}

} // namespace pellucid
