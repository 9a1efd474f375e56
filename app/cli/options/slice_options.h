// --slice, --window, --tf-strength, --nearest: a plane of the grid in place of the view of the volume.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "options/setting_options.h"
#include "session/slice_input.h"

namespace pellucid::cli {

struct SliceOptions {
    struct At {
        int axis = 2;        ///< of the grid
        double fraction = 0; ///< of the box, [0,1]
    };
    std::optional<At> at; ///< empty: no slice
    std::optional<ValueRange> window;
    SettingOptions<SliceViews> given;
    bool nearest = false;

    void add(CLI::App& app);
    void check() const; ///< throws UsageError for options of slices without a slice
    /// The whole plane in a picture of this size; `at` is not empty.
    SlicePlane planeOf(const Geometry& geometry, int width, int height) const;
    /// The option that says how the data look in a slice; null: none was given.
    const char* lookOfData() const;
    /// Of the data or, unless null, of the field; changed by the options.
    SliceInput inputOf(const Scene& scene, const Field* field) const;
};

} // namespace pellucid::cli
