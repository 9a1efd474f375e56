#include "options/slice_options.h"

#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* kSliceGroup = "Slice";

/// "x:P", P in [0,1].
SliceOptions::At parseSlice(const std::string& text, const std::string& option) {
    const std::size_t axis = text.size() > 2 && text[1] == ':' ? std::string("xyz").find(text[0]) : std::string::npos;
    if (axis == std::string::npos)
        throw UsageError("'" + text + "' is not a slice", option,
                         "give x:P, y:P or z:P with P from 0 to 1, a fraction of the box");
    return {static_cast<int>(axis), parseRealFrom(text.substr(2), option, 0, 1)};
}

} // namespace

void SliceOptions::add(CLI::App& app) {
    addValue(
        app, "--slice", "x|y|z:P", at, parseSlice,
        "a plane of the grid in place of the view: perpendicular to its axis x, y or z, at the fraction P of the box "
        "from 0 to 1, in the colours of the transfer function over grey. Of a patient as radiologists are used to: "
        "anterior or superior up, left at the right, in sagittal slices anterior at the left",
        kSliceGroup);
    addValue(app, "--window", "LO,HI", window, parseRange,
             "values that are black and white in a slice (default: the session's, else the intensity range)",
             kSliceGroup);
    given.add(app, kSliceGroup);
    app.add_flag("--nearest", nearest, "each pixel of a slice has the value of the nearest voxel (default: linear)")
        ->group(kSliceGroup);
}

const char* SliceOptions::lookOfData() const {
    return window ? "--window" : given.has("tf_strength") ? "--tf-strength" : nullptr;
}

void SliceOptions::check() const {
    if (at) return;
    const char* alone = lookOfData() != nullptr ? lookOfData() : nearest ? "--nearest" : nullptr;
    if (alone != nullptr) throw UsageError("this option needs --slice", alone, "add --slice, or leave it out");
}

SlicePlane SliceOptions::planeOf(const Geometry& geometry, int width, int height) const {
    return {at->axis, slicePosition(geometry, at->axis, at->fraction), fittedSlice(geometry, at->axis, width, height),
            width, height};
}

SliceInput SliceOptions::inputOf(const Scene& scene, const Field* field) const {
    Scene changed = scene;
    changed.session.slices.edit([&](SliceViews& views) {
        given.applyTo(views);
        if (window) views.window = window;
    });
    SliceInput input = field != nullptr ? fieldSliceInput(changed, *field) : sliceInput(changed);
    input.settings.linear = !nearest;
    return input;
}

} // namespace pellucid::cli
