// VOLUME, --allow-outside, --frames, --frame, --array, --cache, --raw, --spacing, --skip, --missing, --range,
// --component, --axes, --sample-size, --seed, --downsample, --region: what is opened.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "parse.h"
#include "session/scene.h"

namespace pellucid::cli {

inline const auto parseSampleSize = wholeFrom(8, 65536); ///< voxels along the longest axis
/// "X0:X1,Y0:Y1,Z0:Z1".
VoxelRegion parseVoxelRegion(const std::string& text, const std::string& option);

struct VolumeOptions {
    std::optional<std::string> path;
    std::optional<RawLayout> raw;
    std::optional<GridSpacing> spacing;
    std::optional<std::uint64_t> skipBytes;
    std::optional<double> missing;
    std::optional<ValueRange> range;
    std::optional<int> component;
    std::optional<GridAxes> axes;
    std::optional<FrameRange> frames;
    std::optional<int> frame;
    std::optional<std::string> array;
    std::optional<std::size_t> cacheBytes;
    std::optional<int> sampleSize;
    std::optional<int> downsample;
    std::optional<VoxelRegion> region;
    std::optional<std::uint32_t> seed;

    /// --size is a second name of --sample-size, except in commands whose --size is an image's. A command that looks at
    /// an image only sometimes has both. ImageWithRegion, Both: --region may be one of an image, too. Such commands add
    /// what is of both by the two functions below.
    enum class SizeIs { Sample, Image, ImageWithRegion, Both };
    /// Adds a --size of a command whose --size is a sample's, and of an image that it looks at besides.
    void addSizeOfBoth(CLI::App& app, std::function<void(const ImageSize&)> setImage, const std::string& help);
    /// Adds a --region that is of the data where it is three intervals, else what `takeImage` takes, of this form.
    void addRegionOfBoth(CLI::App& app, Take takeImage, const std::string& form, const std::string& help);
    void add(CLI::App& app, SizeIs size = SizeIs::Sample);
    /// Whether any of them but VOLUME is given.
    bool anyDetail() const;
    /// VOLUME replaces the source of the session; the others change it. Throws UsageError where there is none, and for
    /// options that do not go together.
    void applyTo(SceneInputs& inputs) const;

private:
    std::string m_command; ///< its name
};

} // namespace pellucid::cli
