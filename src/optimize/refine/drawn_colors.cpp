#include "optimize/refine/drawn_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "optimize/refine/refine_features.h"

namespace pellucid {

namespace {

constexpr std::size_t kColorBins = 1024; ///< of intensity

struct BinColors {
    std::array<std::uint64_t, 3> sum{}; ///< of 8-bit channels: whole numbers, in any order the same
    std::uint64_t count = 0;
};

std::vector<BinColors> colorsByIntensity(const Volume& volume, const VoxelColors& colors) {
    constexpr std::size_t kPieces = 8;
    std::vector<std::vector<BinColors>> pieces(kPieces, std::vector<BinColors>(kColorBins));
    parallelFor(kPieces, [&](std::size_t piece) {
        const std::size_t end = (piece + 1) * volume.size() / kPieces;
        for (std::size_t i = piece * volume.size() / kPieces; i < end; ++i) {
            const double s = volume.intensity(i);
            if (std::isnan(s)) continue;
            BinColors& bin = pieces[piece][std::min(static_cast<std::size_t>(s * kColorBins), kColorBins - 1)];
            for (std::size_t c = 0; c < 3; ++c) bin.sum[c] += colors.rgba[i] >> (8 * c) & 255u;
            ++bin.count;
        }
    });
    for (std::size_t piece = 1; piece < kPieces; ++piece)
        for (std::size_t b = 0; b < kColorBins; ++b) {
            for (std::size_t c = 0; c < 3; ++c) pieces[0][b].sum[c] += pieces[piece][b].sum[c];
            pieces[0][b].count += pieces[piece][b].count;
        }
    return std::move(pieces[0]);
}

} // namespace

TransferFunction withDrawnColors(const TransferFunction& tf, const Volume& volume, const VoxelColors* colors) {
    if (colors == nullptr || tf.points.empty()) return tf;
    PELLUCID_CHECK(colors->dims == volume.dims());
    const std::vector<BinColors> bins = colorsByIntensity(volume, *colors);
    struct Mean {
        std::array<double, 3> sum{};
        double weight = 0;
    };
    std::vector<Mean> means(tf.points.size());
    const auto add = [&](std::size_t point, double weight, const BinColors& bin) {
        for (std::size_t c = 0; c < 3; ++c) means[point].sum[c] += weight * static_cast<double>(bin.sum[c]) / 255;
        means[point].weight += weight * static_cast<double>(bin.count);
    };
    for (std::size_t b = 0; b < kColorBins; ++b) {
        if (bins[b].count == 0) continue;
        const double s = (static_cast<double>(b) + 0.5) / kColorBins;
        // The first point beyond s; of several in one place the first from below, the last from above.
        const auto next = std::ranges::find_if(
            tf.points, [&](double x) { return x > s; }, &ControlPoint::x);
        const auto upper = static_cast<std::size_t>(next - tf.points.begin());
        if (upper == 0) {
            add(0, 1, bins[b]);
        } else if (upper == tf.points.size()) {
            add(upper - 1, 1, bins[b]);
        } else {
            const double from = tf.points[upper - 1].x, to = tf.points[upper].x;
            const double t = (s - from) / (to - from);
            add(upper - 1, 1 - t, bins[b]);
            add(upper, t, bins[b]);
        }
    }
    TransferFunction drawn = tf;
    for (std::size_t i = 0; i < means.size(); ++i)
        if (means[i].weight > 0)
            drawn.points[i].color = {means[i].sum[0] / means[i].weight, means[i].sum[1] / means[i].weight,
                                     means[i].sum[2] / means[i].weight};
    return drawn;
}

RefineResult refineAsDrawn(const Histogram& histogram, const TransferFunction& tf, const Volume& volume,
                           const VoxelColors* colors, const RefineOptions& options, const JobControl& job) {
    if (colors == nullptr || options.priority.region.empty()) return refine(histogram, tf, options, job);
    RefineResult result = refine(histogram, withDrawnColors(tf, volume, colors), options, job);
    result.tf = withOpacitiesOf(tf, result.tf);
    return result;
}

} // namespace pellucid
