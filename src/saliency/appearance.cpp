#include "saliency/appearance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/check.h"
#include "base/parallel.h"
#include "tf/lch.h"
#include "volume/memory_use.h"
#include "volume/voxel_loops.h"

namespace pellucid {

namespace {

constexpr int kBins = 1 << 14; ///< a power of two, so that s·kBins is exact
constexpr double kBinTolerance = 1e-5;

AppearanceReader::Pair pairOf(const Appearance& a) {
    return std::bit_cast<AppearanceReader::Pair>(
        std::array<float, 2>{static_cast<float>(a.brightness), static_cast<float>(a.saturation)});
}

/// Whether leaving out `p`, between `a` and `b`, changes no colour.
bool onLine(const ControlPoint& a, const ControlPoint& p, const ControlPoint& b) {
    if (a.x == p.x || p.x == b.x) return (a.x == p.x && a.color == p.color) || (p.x == b.x && p.color == b.color);
    const double t = (p.x - a.x) / (b.x - a.x);
    const auto close = [t](double from, double v, double to) { return std::abs(from + t * (to - from) - v) < 1e-12; };
    return close(a.color.r, p.color.r, b.color.r) && close(a.color.g, p.color.g, b.color.g) &&
           close(a.color.b, p.color.b, b.color.b);
}

Rgb rgbOf(std::uint32_t voxelColor) {
    return {(voxelColor & 255u) / 255.0, (voxelColor >> 8 & 255u) / 255.0, (voxelColor >> 16 & 255u) / 255.0};
}

/// Whether all values of a type fit into a table.
template <class T>
constexpr bool kTabulated = sizeof(T) <= 2;

} // namespace

Appearance appearanceOf(const Rgb& srgb) {
    const Lch lch = lchFromSrgb(srgb);
    return {lch.lightness / 100, lch.chroma / 100};
}

AppearanceReader::AppearanceReader(const Volume& volume, const TransferFunction& tf, const Rgb& background,
                                   const VoxelColors* colors)
    : m_volume(volume), m_colors(colors), m_sampler(tf), m_features(tf.features),
      m_background(appearanceOf(background)) {
    if (m_colors != nullptr) {
        PELLUCID_CHECK(m_colors->dims == volume.dims());
        return;
    }
    for (const Feature& f : m_features) m_breaks.insert(m_breaks.end(), {f.a, f.b});
    for (const ControlPoint& p : tf.points) m_breaks.push_back(p.x);
    if (bytesPerSample(volume.sampleType()) <= 2)
        tabulateSamples();
    else if (volume.size() > 4 * kBins)
        tabulateIntensities();
}

Appearance AppearanceReader::atIntensity(double s) const {
    if (featureAt(m_features, s) < 0) return m_background; // NaN is in no feature
    return appearanceOf(m_sampler.color(s));
}

AppearanceReader::Pair AppearanceReader::pairAt(double s, Latest& latest) const {
    if (s == latest.intensity) return latest.ofIntensity;
    latest.intensity = s;
    if (featureAt(m_features, s) < 0) return latest.ofIntensity = pairOf(m_background);
    const Rgb color = m_sampler.color(s);
    if (!(color == latest.color)) latest.ofColor = pairOf(appearanceOf(color));
    latest.color = color;
    return latest.ofIntensity = latest.ofColor;
}

void AppearanceReader::tabulateSamples() {
    withSamples(m_volume, [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (kTabulated<T>) {
            constexpr int kLowest = std::numeric_limits<T>::min(), kHighest = std::numeric_limits<T>::max();
            m_ofSample.resize(static_cast<std::size_t>(kHighest - kLowest + 1));
            constexpr int kPiece = 256;
            parallelFor(m_ofSample.size() / kPiece, [&](std::size_t piece) {
                Latest latest;
                for (std::size_t i = piece * kPiece; i < (piece + 1) * kPiece; ++i)
                    m_ofSample[i] = pairAt(m_volume.intensityOfValue(kLowest + static_cast<int>(i)), latest);
            });
        }
    });
}

/// The bin [index, index + 1) / kBins. Whether its colours lie on a line is asked at a few points, and on both sides of
/// every place where features or colours may change.
AppearanceReader::Bin AppearanceReader::binAt(int index) const {
    const double lower = static_cast<double>(index) / kBins;
    const double upper = index + 1 < kBins ? std::nextafter(static_cast<double>(index + 1) / kBins, 0.0) : 1.0;
    const Appearance a = atIntensity(lower), b = atIntensity(upper);
    const double db = b.brightness - a.brightness, ds = b.saturation - a.saturation;
    const auto bends = [&](double s) {
        const Appearance o = atIntensity(s);
        const double t = s * kBins - index;
        return std::abs(o.brightness - (a.brightness + t * db)) > kBinTolerance ||
               std::abs(o.saturation - (a.saturation + t * ds)) > kBinTolerance;
    };
    bool linear = !(bends(lower + 0.25 / kBins) || bends(lower + 0.5 / kBins) || bends(lower + 0.75 / kBins));
    for (const double s : m_breaks)
        if (s > lower && s <= upper) linear = linear && !bends(s) && !bends(std::nextafter(s, 0.0));
    Bin bin{static_cast<float>(a.brightness), static_cast<float>(a.saturation), static_cast<float>(db),
            static_cast<float>(ds)};
    if (!linear) bin.brightnessStep = std::numeric_limits<float>::quiet_NaN();
    return bin;
}

void AppearanceReader::tabulateIntensities() {
    m_ofIntensity.resize(kBins);
    constexpr int kPiece = 256;
    parallelFor(kBins / kPiece, [&](std::size_t piece) {
        for (std::size_t i = piece * kPiece; i < (piece + 1) * kPiece; ++i)
            m_ofIntensity[i] = binAt(static_cast<int>(i));
    });
}

void AppearanceReader::readColoredRow(std::size_t first, int count, Pair* out) const {
    // Neighbours have few different colours, but not in runs.
    struct Known {
        std::uint32_t color = 0; // no voxel's: those have an opaque byte
        Pair pair = 0;
    };
    constexpr std::uint32_t kKnown = 1024;
    thread_local std::array<Known, kKnown> s_known;
    const Pair background = pairOf(m_background);
    withSamples(m_volume, [&](const auto& values) {
        for (int x = 0; x < count; ++x) {
            const std::size_t voxel = first + static_cast<std::size_t>(x);
            const double s = m_volume.intensityOfValue(static_cast<double>(values[voxel]));
            if (featureAt(m_features, s) < 0) {
                out[x] = background;
                continue;
            }
            const std::uint32_t color = m_colors->rgba[voxel];
            Known& known = s_known[(color * 2654435761u) >> 22];
            if (known.color != color) known = {color, pairOf(appearanceOf(rgbOf(color)))};
            out[x] = known.pair;
        }
    });
}

Appearance AppearanceReader::at(std::size_t voxel) const {
    const double s = m_volume.intensity(voxel);
    if (m_colors == nullptr) return atIntensity(s);
    return featureAt(m_features, s) < 0 ? m_background : appearanceOf(rgbOf(m_colors->rgba[voxel]));
}

void AppearanceReader::readRow(std::size_t first, int count, Pair* out) const {
    if (m_colors != nullptr) return readColoredRow(first, count, out);
    withSamples(m_volume, [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const T* row = values.data() + first;
        if constexpr (kTabulated<T>) {
            const Pair* table = m_ofSample.data();
            constexpr int kLowest = std::numeric_limits<T>::min();
            for (int x = 0; x < count; ++x) out[x] = table[row[x] - kLowest];
        } else {
            Latest latest;
            for (int x = 0; x < count; ++x) {
                const double s = m_volume.intensityOfValue(static_cast<double>(row[x]));
                if (m_ofIntensity.empty() || std::isnan(s)) {
                    out[x] = pairAt(s, latest);
                    continue;
                }
                const double scaled = s * kBins;
                const int index = std::min(static_cast<int>(scaled), kBins - 1);
                const Bin& bin = m_ofIntensity[static_cast<std::size_t>(index)];
                if (std::isnan(bin.brightnessStep)) {
                    out[x] = pairAt(s, latest);
                    continue;
                }
                const float t = static_cast<float>(scaled - index);
                out[x] = std::bit_cast<Pair>(std::array<float, 2>{bin.brightness + t * bin.brightnessStep,
                                                                  bin.saturation + t * bin.saturationStep});
            }
        }
    });
}

BallKernel::BallKernel(const Geometry& geometry, double radiusInD0, SaliencyKernel kernel) {
    const double scale = kernel == SaliencyKernel::Thesis ? 2 * radiusInD0 : radiusInD0 / 4;
    const Vec3 unit = geometry.spacing / geometry.d0(); // one voxel along each axis, in d0
    const double limit = radiusInD0 * radiusInD0;
    for (int axis = 0; axis < 3; ++axis) {
        auto& w = weights[static_cast<std::size_t>(axis)];
        for (int d = 0; std::pow(d * unit[axis], 2) < limit; ++d)
            w.push_back(std::exp(-std::pow(d * unit[axis] / scale, 2)));
    }
    for (int dz = -reach(2); dz <= reach(2); ++dz)
        for (int dy = -reach(1); dy <= reach(1); ++dy) {
            const double rest = std::pow(dy * unit.y, 2) + std::pow(dz * unit.z, 2);
            int half = -1;
            while (half < reach(0) && std::pow((half + 1) * unit.x, 2) + rest < limit) ++half;
            if (half >= 0) runs.push_back({dy, dz, half});
        }
}

template <>
std::span<const Setting> settingsOf<SaliencyOptions>() {
    using S = SaliencyOptions;
    static constexpr const char* kKernels[] = {"Thesis (4.7)", "Narrow"};
    static const Setting kSettings[] = {
        {.key = "sigma",
         .at = member<&S::sigma>,
         .words = "σ",
         .help =
             "The radius of the centre in reference lengths (voxels, where they are cubes); that of the surround is "
             "twice as large.",
         .range = {0, 8, NumberRange::Open::Low},
         .unit = "d0"},
        {.key = "kernel",
         .at = member<&S::kernel>,
         .words = "&Kernel",
         .help = "The weights within the radius: exp(−d²/(2σ)²), eq. 4.7, or narrow, a Gaussian of √2/8 of the radius, "
                 "as the author's published programs have it.",
         .choices = kKernels},
        {.key = "w1",
         .at = member<&S::w1>,
         .words = "w1",
         .help = "The weight of the centre in |w1·G(σ) − w2·G(2σ)|, eq. 4.8.",
         .range = {0, 1e6}},
        {.key = "w2",
         .at = member<&S::w2>,
         .words = "w2",
         .help = "The weight of the surround in |w1·G(σ) − w2·G(2σ)|, eq. 4.8.",
         .range = {0, 1e6}},
        {.key = "background",
         .at = member<&S::background>,
         .words = "Colour outside features",
         .help = "The colour that voxels in no feature have for saliency; the background of the picture is another.",
         .option = "saliency-background"},
    };
    return kSettings;
}

void validate(const SaliencyOptions& options) { checkSettings(options, "saliency"); }

TransferFunction colorsOf(const TransferFunction& tf) {
    const std::vector<ControlPoint> points = tf.pointsWithEnds();
    TransferFunction colors;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ControlPoint p{points[i].x, 0.0, points[i].color, false, {}};
        const bool inner = i > 0 && i + 1 < points.size();
        if (inner && onLine(colors.points.back(), p, points[i + 1])) continue;
        colors.points.push_back(p);
    }
    for (const Feature& f : tf.features) colors.features.push_back({{}, f.a, f.b, {}, {}});
    return colors;
}

WeightForm weightFormOf(const Int3& dims) {
    return voxelCount(dims) >= kLeanVoxels ? WeightForm::Compact : WeightForm::Exact;
}

WeightFields emptyWeightFields(const Int3& dims, const SaliencyOptions& options, std::optional<WeightForm> form) {
    const double w = std::max(options.w1, options.w2);
    return {dims, w, 1.34 * w, form.value_or(weightFormOf(dims))};
}

bool keepWeightFields(WeightFields& fields, const Int3& dims, const SaliencyOptions& options,
                      std::optional<WeightForm> form) {
    const WeightFields scales = emptyWeightFields(Int3(0), options);
    if (fields.dims() == dims && fields.scale(0) == scales.scale(0) && fields.scale(1) == scales.scale(1)) return true;
    fields = {}; // before the new ones, so that both never need room at once
    fields = emptyWeightFields(dims, options, form);
    return false;
}

} // namespace pellucid
