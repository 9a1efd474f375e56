#include "volume/histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

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
    /// Where a value counts.
    struct Place {
        int bin = -1; ///< none: it is invalid
        std::uint16_t code = 0;
    };
    const auto placeOf = [&](double value) {
        const double s = volume.intensityOfValue(value);
        return std::isnan(s) ? Place{} : Place{histogramBin(s, bins), coder.code(s)};
    };
    const auto count = [&]<class T>(const SampleArray<T>& values) {
        constexpr bool kFewValues = std::is_integral_v<T> && sizeof(T) <= 2;
        constexpr int kLowest = kFewValues ? static_cast<int>(std::numeric_limits<T>::lowest()) : 0;
        // Where so few values are possible that pieces have more voxels, each value is counted, and what it counts for
        // is found once.
        std::vector<Place> places;
        if constexpr (kFewValues)
            if (values.size() >> (8 * sizeof(T)) > kPieces)
                for (int v = kLowest; v <= std::numeric_limits<T>::max(); ++v) places.push_back(placeOf(v));
        parallelFor(partial.size(), [&](std::size_t p) {
            auto& counts = partial[p];
            counts.assign(static_cast<std::size_t>(bins), 0);
            occursIn[p].assign(codes, 0);
            const auto add = [&](const Place& place, std::uint64_t voxels) {
                if (place.bin < 0 || voxels == 0) return;
                counts[static_cast<std::size_t>(place.bin)] += voxels;
                occursIn[p][place.code] = 1;
            };
            // Neighbours are often alike: two tables, so that an addition need not wait for the one before.
            std::array<std::vector<std::uint64_t>, 2> ofValue;
            for (auto& table : ofValue) table.assign(places.size(), 0);
            const int piece = static_cast<int>(p);
            part.forOwnRows(
                layers * piece / pieces, layers * (piece + 1) / pieces, [&](const Int3&, std::size_t row, int voxels) {
                    const std::size_t end = row + static_cast<std::size_t>(voxels);
                    for (std::size_t i = row; i < end; ++i) {
                        if (kFewValues && !places.empty())
                            ++ofValue[i % 2][static_cast<std::size_t>(static_cast<int>(values[i]) - kLowest)];
                        else
                            add(placeOf(static_cast<double>(values[i])), 1);
                    }
                });
            for (std::size_t v = 0; v < places.size(); ++v) add(places[v], ofValue[0][v] + ofValue[1][v]);
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
