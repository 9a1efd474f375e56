#include "optimize/fields.h"

#include <algorithm>
#include <atomic>

#include "base/check.h"
#include "base/parallel.h"

namespace pellucid {

namespace {

/// Calls body(first, last) for pieces of [0, count) whose borders depend on nothing else, piece by piece into `slots`.
constexpr std::size_t kPiece = std::size_t{1} << 18;

template <class Body>
void inPieces(std::size_t count, const JobControl& job, const Body& body) {
    const std::size_t pieces = (count + kPiece - 1) / kPiece;
    std::atomic<std::size_t> done{0};
    parallelFor(pieces, [&](std::size_t piece) {
        job.throwIfStopped();
        body(piece, piece * kPiece, std::min(count, (piece + 1) * kPiece));
        job.report(static_cast<double>(++done) / static_cast<double>(pieces));
    });
}

/// Σ of both attributes over all voxels, those of other processes too, each times `factor(voxel)`.
template <class Factor>
std::array<double, 2> sumsOf(const WeightFields& weights, const JobControl& job, const VoxelsElsewhere* elsewhere,
                             const Factor& factor) {
    std::vector<std::array<double, 2>> slots((weights.size() + kPiece - 1) / kPiece);
    inPieces(weights.size(), {job.stop, {}}, [&](std::size_t piece, std::size_t first, std::size_t last) {
        std::array<double, 2> sum{0, 0};
        for (std::size_t i = first; i < last; ++i) {
            const double f = factor(i);
            sum[0] += f * static_cast<double>(weights.brightness(i));
            sum[1] += f * static_cast<double>(weights.saturation(i));
        }
        slots[piece] = sum;
    });
    std::array<double, 2> all{0, 0};
    for (const auto& slot : slots)
        for (std::size_t w = 0; w < 2; ++w) all[w] += slot[w];
    if (elsewhere != nullptr) elsewhere->sum(all);
    return all;
}

} // namespace

const char* title(FieldKind kind) {
    constexpr std::array kTitles{"Visibility", "Saliency of brightness", "Saliency of saturation", "Saliency",
                                 "Visibility-weighted saliency"};
    return kTitles[static_cast<std::size_t>(kind)];
}

std::string fileStem(FieldKind kind) {
    std::string stem = name(kind);
    std::ranges::replace(stem, '-', '_');
    return stem;
}

Grid<float> saliencyGrid(const WeightFields& weights, FieldKind kind, const VwsOptions& options, const JobControl& job,
                         const VoxelsElsewhere* elsewhere) {
    PELLUCID_CHECK(!dependsOnView(kind));
    std::array<double, 2> u{kind == FieldKind::SaliencyBrightness ? 1.0 : 0.0,
                            kind == FieldKind::SaliencySaturation ? 1.0 : 0.0};
    if (kind == FieldKind::Saliency)
        // Only whether they are 0 matters, so that voxels that two processes have may count twice.
        u = attributeWeights(sumsOf(weights, job, elsewhere, [](std::size_t) { return 1.0; }), options);
    Grid<float> field(weights.dims());
    inPieces(field.size(), job, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            field[i] = static_cast<float>(u[0] * static_cast<double>(weights.brightness(i)) +
                                          u[1] * static_cast<double>(weights.saturation(i)));
    });
    return field;
}

void visibilityToVws(Grid<float>& visibility, const WeightFields& weights, const VwsOptions& options,
                     const JobControl& job, const VoxelsElsewhere* elsewhere) {
    PELLUCID_CHECK(visibility.dims() == weights.dims());
    const std::array<double, 2> all =
        sumsOf(weights, job, elsewhere, [&](std::size_t i) { return static_cast<double>(visibility[i]); });
    const auto [u1, u2] = attributeWeights(all, options);
    const double b = all[0] > 0 ? u1 / all[0] : 0.0, s = all[1] > 0 ? u2 / all[1] : 0.0;
    inPieces(visibility.size(), job, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            visibility[i] = static_cast<float>(
                static_cast<double>(visibility[i]) *
                (b * static_cast<double>(weights.brightness(i)) + s * static_cast<double>(weights.saturation(i))));
    });
}

void keepFeature(Grid<float>& field, const Volume& volume, const TransferFunction& tf, int feature,
                 const JobControl& job) {
    if (feature < 0) return;
    PELLUCID_CHECK(field.dims() == volume.dimsHere() && static_cast<std::size_t>(feature) < tf.features.size());
    const Feature& kept = tf.features[static_cast<std::size_t>(feature)];
    const Volume* const here = volume.elsewhere() != nullptr ? volume.here().get() : &volume;
    inPieces(field.size(), job, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            if (!kept.contains(here->intensity(i))) field[i] = 0; // an invalid voxel's is NaN, which is in none
    });
}

double usualTop(const Grid<float>& field) {
    constexpr std::size_t kMost = 1'000'000;
    const std::size_t stride = (field.size() + kMost - 1) / kMost | 1; // odd, so that it divides few row lengths
    std::vector<float> positive;
    for (std::size_t i = 0; i < field.size(); i += stride)
        if (field[i] > 0) positive.push_back(field[i]);
    if (positive.empty()) {
        const auto largest = std::ranges::max_element(field);
        return largest != field.end() && *largest > 0 ? static_cast<double>(*largest) : 1.0;
    }
    const auto at = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(positive.size() - 1) + 0.5);
    std::nth_element(positive.begin(), positive.begin() + at, positive.end());
    return static_cast<double>(positive[static_cast<std::size_t>(at)]);
}

Field fieldVolume(const Geometry& geometry, const Grid<float>& values, double top, std::string title) {
    Volume volume(geometry, Samples(SampleArray<float>(std::vector<float>(values.begin(), values.end()))));
    const double largest = volume.dataRange().hi;
    volume = volume.withRange({0, largest > 0 ? largest : 1.0});
    volume.title = std::move(title);
    volume.format = "field";
    return {std::make_shared<const Volume>(std::move(volume)), top};
}

} // namespace pellucid
