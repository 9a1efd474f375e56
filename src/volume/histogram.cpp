#include "volume/histogram.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "volume/intensity_grid.h"
#include "volume/voxel_loops.h"

namespace pellucid {

int histogramBin(double s, int bins) { return std::clamp(static_cast<int>(std::floor(s * bins)), 0, bins - 1); }

namespace {

/// Of the voxels that each process answers for.
Histogram histogramOfAll(const Volume& volume, int bins) {
    const IntensityCoder coder(volume);
    const auto codes = static_cast<std::size_t>(coder.maxCode()) + 1;
    std::vector<double> found(static_cast<std::size_t>(bins) + codes, 0.0); // counts, then which codes occur
    if (const Volume* here = volume.here().get()) {
        const VoxelRegion own = volume.elsewhere()->own(), stored = volume.elsewhere()->stored();
        withSamples(*here, [&](const auto& values) {
            for (int k = own.lo.z; k < own.hi.z; ++k)
                for (int j = own.lo.y; j < own.hi.y; ++j) {
                    const Int3 at = Int3(own.lo.x, j, k) - stored.lo;
                    std::size_t i = voxelIndex(here->dims(), at.x, at.y, at.z);
                    for (int x = own.lo.x; x < own.hi.x; ++x, ++i) {
                        const double s = here->intensityOfValue(static_cast<double>(values[i]));
                        if (std::isnan(s)) continue;
                        ++found[static_cast<std::size_t>(histogramBin(s, bins))];
                        found[static_cast<std::size_t>(bins) + coder.code(s)] = 1;
                    }
                }
        });
    }
    volume.elsewhere()->sum(found);
    Histogram histogram;
    for (std::size_t b = 0; b < static_cast<std::size_t>(bins); ++b)
        histogram.counts.push_back(static_cast<std::uint64_t>(found[b]));
    for (const std::uint64_t c : histogram.counts) histogram.total += c;
    histogram.maxCode = coder.maxCode();
    for (std::size_t code = 0; code < codes; ++code)
        if (found[static_cast<std::size_t>(bins) + code] > 0)
            histogram.codes.push_back(static_cast<std::uint16_t>(code));
    return histogram;
}

} // namespace

Histogram makeHistogram(const Volume& volume, int bins) {
    if (volume.elsewhere() != nullptr) return histogramOfAll(volume, bins);
    const std::size_t slices = static_cast<std::size_t>(volume.dims().z);
    const std::size_t plane = volume.size() / slices;
    constexpr std::size_t kPieces = 32; // few, since each piece carries its own bins
    const std::size_t pieces = std::min(kPieces, slices);
    const IntensityCoder coder(volume);
    const std::size_t codes = static_cast<std::size_t>(coder.maxCode()) + 1;
    std::vector<std::vector<std::uint64_t>> partial(pieces);
    std::vector<std::vector<std::uint8_t>> occurs(pieces); // by code
    withSamples(volume, [&](const auto& values) {
        parallelFor(pieces, [&](std::size_t p) {
            auto& counts = partial[p];
            counts.assign(static_cast<std::size_t>(bins), 0);
            occurs[p].assign(codes, 0);
            const std::size_t end = plane * (slices * (p + 1) / pieces);
            for (std::size_t i = plane * (slices * p / pieces); i < end; ++i) {
                const double s = volume.intensityOfValue(static_cast<double>(values[i]));
                if (std::isnan(s)) continue;
                ++counts[static_cast<std::size_t>(histogramBin(s, bins))];
                occurs[p][coder.code(s)] = 1;
            }
        });
    });
    Histogram histogram;
    histogram.counts.assign(static_cast<std::size_t>(bins), 0);
    for (const auto& counts : partial)
        for (std::size_t b = 0; b < counts.size(); ++b) histogram.counts[b] += counts[b];
    for (const std::uint64_t c : histogram.counts) histogram.total += c;
    histogram.maxCode = coder.maxCode();
    for (std::size_t code = 0; code < codes; ++code)
        if (std::any_of(occurs.begin(), occurs.end(), [&](const auto& piece) { return piece[code] != 0; }))
            histogram.codes.push_back(static_cast<std::uint16_t>(code));
    return histogram;
}

} // namespace pellucid
