#include "volume/histogram.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "volume/intensity_grid.h"
#include "volume/volume_part.h"
#include "volume/voxel_loops.h"

namespace pellucid {

int histogramBin(double s, int bins) { return std::clamp(static_cast<int>(std::floor(s * bins)), 0, bins - 1); }

namespace {

/// Counts of all processes, and the codes that occur in any.
void addUp(const VoxelsElsewhere& all, std::vector<std::uint64_t>& counts, std::vector<std::uint8_t>& occurs) {
    std::vector<double> sums(counts.begin(), counts.end());
    sums.insert(sums.end(), occurs.begin(), occurs.end());
    all.sum(sums);
    for (std::size_t b = 0; b < counts.size(); ++b) counts[b] = static_cast<std::uint64_t>(sums[b]);
    for (std::size_t code = 0; code < occurs.size(); ++code) occurs[code] = sums[counts.size() + code] > 0;
}

} // namespace

Histogram makeHistogram(const Volume& volume, int bins) {
    const VolumePart part = partHere(volume);
    constexpr int kPieces = 32; // few, since each piece carries its own bins
    const int layers = part.ownLayers(), pieces = std::min(kPieces, layers);
    const IntensityCoder coder(volume);
    const auto codes = static_cast<std::size_t>(coder.maxCode()) + 1;
    std::vector<std::vector<std::uint64_t>> partial(static_cast<std::size_t>(pieces));
    std::vector<std::uint8_t> occurs(codes, 0);
    std::vector<std::vector<std::uint8_t>> occursIn(partial.size()); // by code
    const auto count = [&](const auto& values) {
        parallelFor(partial.size(), [&](std::size_t p) {
            auto& counts = partial[p];
            counts.assign(static_cast<std::size_t>(bins), 0);
            occursIn[p].assign(codes, 0);
            const int piece = static_cast<int>(p);
            part.forOwnRows(layers * piece / pieces, layers * (piece + 1) / pieces,
                            [&](const Int3&, std::size_t row, int voxels) {
                                const std::size_t end = row + static_cast<std::size_t>(voxels);
                                for (std::size_t i = row; i < end; ++i) {
                                    const double s = volume.intensityOfValue(static_cast<double>(values[i]));
                                    if (std::isnan(s)) continue;
                                    ++counts[static_cast<std::size_t>(histogramBin(s, bins))];
                                    occursIn[p][coder.code(s)] = 1;
                                }
                            });
        });
    };
    if (part.volume != nullptr) withSamples(*part.volume, count);
    Histogram histogram;
    histogram.counts.assign(static_cast<std::size_t>(bins), 0);
    for (const auto& counts : partial)
        for (std::size_t b = 0; b < counts.size(); ++b) histogram.counts[b] += counts[b];
    for (const auto& piece : occursIn)
        for (std::size_t code = 0; code < codes; ++code) occurs[code] |= piece[code];
    if (volume.elsewhere() != nullptr) addUp(*volume.elsewhere(), histogram.counts, occurs);
    for (const std::uint64_t c : histogram.counts) histogram.total += c;
    histogram.maxCode = coder.maxCode();
    for (std::size_t code = 0; code < codes; ++code)
        if (occurs[code] != 0) histogram.codes.push_back(static_cast<std::uint16_t>(code));
    return histogram;
}

} // namespace pellucid
