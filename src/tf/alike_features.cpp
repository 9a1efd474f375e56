#include "tf/alike_features.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "base/round_numbers.h"
#include "tf/color_spaces.h"
#include "tf/edit.h"

namespace pellucid {

namespace {

constexpr int kSamplesOfFeature = 64;
constexpr std::array kViewers{VisionKind::Normal, VisionKind::Protanopia, VisionKind::Deuteranopia,
                              VisionKind::Tritanopia};
constexpr double kRoundingMargin = 0.3; ///< of CIEDE2000, for colours that are kept with 8 bits

/// A colour as each of kViewers sees it.
using Seen = std::array<Lab, kViewers.size()>;

Seen seenByAll(const Rgb& color) {
    static const std::array<LightMatrix, kViewers.size()> kMatrices = [] {
        std::array<LightMatrix, kViewers.size()> all{};
        for (std::size_t v = 0; v < all.size(); ++v) all[v] = visionMatrix(kViewers[v]);
        return all;
    }();
    const Rgb light{linearFromSrgb(color.r), linearFromSrgb(color.g), linearFromSrgb(color.b)};
    Seen seen;
    for (std::size_t v = 0; v < seen.size(); ++v) seen[v] = labFromLinear(seenLight(light, kMatrices[v]));
    return seen;
}

struct Difference {
    double least = std::numeric_limits<double>::infinity();
    VisionKind vision = VisionKind::Normal;
};

/// As the viewer sees it to whom both are most alike.
Difference differenceOf(const Seen& p, const Seen& q) {
    Difference difference;
    for (std::size_t v = 0; v < p.size(); ++v)
        if (const double d = ciede2000(p[v], q[v]); d < difference.least) difference = {d, kViewers[v]};
    return difference;
}

/// Colours that are moved until all viewers can tell them apart.
class Mending {
public:
    Mending(const std::vector<Rgb>& colors, double wanted) : m_original(colors), m_wanted(wanted) {
        for (const Rgb& color : colors) {
            m_lch.push_back(lchFromSrgb(color));
            m_colors.push_back(color);
            m_seen.push_back(seenByAll(color));
        }
        m_byLightness.resize(colors.size());
        std::iota(m_byLightness.begin(), m_byLightness.end(), std::size_t{0});
        std::ranges::stable_sort(m_byLightness, {}, [&](std::size_t i) { return m_lch[i].lightness; });
    }

    const std::vector<Rgb>& colors() const { return m_colors; }

    /// Moves one colour at a time; whether all are apart.
    bool moveOneByOne() {
        const std::size_t most = 6 * m_colors.size();
        for (std::size_t round = 0; round < most; ++round) {
            const Worst worst = worstPair();
            if (worst.difference >= m_wanted) return true;
            const Candidate a = best(worst.first), b = best(worst.second);
            const Candidate& better = b.isBetterThan(a, m_wanted) ? b : a;
            if (better.apart <= worst.difference + 1e-6) return false;
            put(better.index, better.color);
        }
        return worstPair().difference >= m_wanted;
    }

    /// The same order of lightness, evenly from dark to light: room for those that stand too close.
    void spreadLightness() {
        constexpr double kDarkest = 32, kLightest = 95;
        const std::size_t n = m_byLightness.size();
        for (std::size_t rank = 0; rank < n; ++rank) {
            Lch lch = m_lch[m_byLightness[rank]];
            lch.lightness = kDarkest + (kLightest - kDarkest) * static_cast<double>(rank) / static_cast<double>(n - 1);
            put(m_byLightness[rank], srgbFromLch(lch));
        }
    }

private:
    struct Worst {
        std::size_t first = 0, second = 0;
        double difference = std::numeric_limits<double>::infinity();
    };
    struct Candidate {
        std::size_t index = 0;
        Rgb color;
        double apart = 0;                                       ///< from the nearest other one
        double moved = std::numeric_limits<double>::infinity(); ///< CIEDE2000 from what it was at first
        bool isBetterThan(const Candidate& o, double wanted) const {
            const bool enough = apart >= wanted, isOther = o.apart >= wanted;
            if (enough != isOther) return enough;
            return enough ? moved < o.moved : apart > o.apart;
        }
    };

    void put(std::size_t index, const Rgb& color) {
        m_colors[index] = color;
        m_lch[index] = lchFromSrgb(color);
        m_seen[index] = seenByAll(color);
    }

    Worst worstPair() const {
        Worst worst;
        for (std::size_t i = 0; i < m_seen.size(); ++i)
            for (std::size_t j = i + 1; j < m_seen.size(); ++j)
                if (const double d = differenceOf(m_seen[i], m_seen[j]).least; d < worst.difference) worst = {i, j, d};
        return worst;
    }

    double apartFromOthers(std::size_t index, const Seen& seen, double enough) const {
        double apart = std::numeric_limits<double>::infinity();
        for (std::size_t other = 0; other < m_seen.size() && apart > enough; ++other)
            if (other != index) apart = std::min(apart, differenceOf(seen, m_seen[other]).least);
        return apart;
    }

    /// Where colour `index` may lie without changing places with those that are darker and lighter.
    std::pair<double, double> lightnessOf(std::size_t index) const {
        constexpr double kDarkest = 25, kLightest = 97, kStep = 1;
        const std::size_t rank =
            static_cast<std::size_t>(std::ranges::find(m_byLightness, index) - m_byLightness.begin());
        const double below = rank == 0 ? kDarkest : m_lch[m_byLightness[rank - 1]].lightness + kStep;
        const double above =
            rank + 1 == m_byLightness.size() ? kLightest : m_lch[m_byLightness[rank + 1]].lightness - kStep;
        return {below, above};
    }

    Candidate best(std::size_t index) const {
        constexpr double kHues[] = {0, 12, -12, 24, -24, 36, -36, 50, -50, 70, -70, 100, -100, 180};
        constexpr int kLightnesses = 20;
        const auto [darkest, lightest] = lightnessOf(index);
        const Lch original = lchFromSrgb(m_original[index]);
        const Lab from = labFromSrgb(m_original[index]);
        Candidate best{index, m_colors[index], -1};
        if (darkest > lightest) return best;
        for (int l = 0; l <= kLightnesses; ++l)
            for (const double chroma :
                 {original.chroma, 0.7 * original.chroma, 1.3 * original.chroma, 20.0, 45.0, 70.0})
                for (const double turn : kHues) {
                    const Lch wanted{darkest + (lightest - darkest) * l / kLightnesses, chroma,
                                     original.hueDegrees + turn};
                    Candidate one{index, srgbFromLch(wanted)};
                    one.moved = ciede2000(labFromSrgb(one.color), from);
                    if (best.apart >= m_wanted && one.moved >= best.moved) continue;
                    one.apart = apartFromOthers(index, seenByAll(one.color), std::min(best.apart, m_wanted));
                    if (one.isBetterThan(best, m_wanted)) best = one;
                }
        return best;
    }

    std::vector<Rgb> m_original, m_colors;
    std::vector<Lch> m_lch;
    std::vector<Seen> m_seen;
    std::vector<std::size_t> m_byLightness; ///< indices, the darkest first
    double m_wanted;
};

std::string viewerText(VisionKind vision) {
    return vision == VisionKind::Normal ? std::string("all viewers") : std::string("a viewer with ") + name(vision);
}

std::optional<TransferFunction> applied(const TransferFunction& tf, const std::vector<std::size_t>& among,
                                        const std::vector<Rgb>& before, const std::vector<Rgb>& colors, double wanted) {
    TransferFunction result = tf;
    for (std::size_t i = 0; i < among.size(); ++i)
        if (colors[i] != before[i]) result = withFeatureColor(result, static_cast<int>(among[i]), colors[i]);
    if (!alikeFeatures(result, among, wanted).empty()) return {};
    return result;
}

} // namespace

std::vector<std::size_t> featuresToTell(const TransferFunction& tf) {
    const std::vector<double> peaks = featureOpacities(tf);
    std::vector<std::size_t> all;
    for (std::size_t f = 0; f < peaks.size(); ++f)
        if (!tf.features[f].hidden && peaks[f] >= kLeastSeenOpacity) all.push_back(f);
    return all;
}

std::vector<Rgb> featureColors(const TransferFunction& tf) {
    const TfSampler sampler(tf);
    std::vector<Rgb> colors;
    for (const Feature& f : tf.features) {
        Rgb light;
        double weight = 0;
        for (int i = 0; i < kSamplesOfFeature; ++i) {
            const double s = f.a + (f.b - f.a) * (i + 0.5) / kSamplesOfFeature, alpha = sampler.opacity(s);
            const Rgb color = sampler.color(s);
            light.r += alpha * linearFromSrgb(color.r);
            light.g += alpha * linearFromSrgb(color.g);
            light.b += alpha * linearFromSrgb(color.b);
            weight += alpha;
        }
        colors.push_back(weight > 0 ? Rgb{srgbFromLinear(light.r / weight), srgbFromLinear(light.g / weight),
                                          srgbFromLinear(light.b / weight)}
                                    : f.color);
    }
    return colors;
}

std::vector<AlikePair> alikeFeatures(const TransferFunction& tf, const std::vector<std::size_t>& among, double wanted) {
    const std::vector<Rgb> colors = featureColors(tf);
    std::vector<Seen> seen;
    for (const std::size_t f : among) seen.push_back(seenByAll(colors.at(f)));
    std::vector<AlikePair> pairs;
    for (std::size_t i = 0; i < among.size(); ++i)
        for (std::size_t j = i + 1; j < among.size(); ++j) {
            // Whoever sees all colours and cannot tell them apart is not alone.
            if (const double normal = ciede2000(seen[i][0], seen[j][0]); normal < wanted)
                pairs.push_back({among[i], among[j], VisionKind::Normal, normal});
            else if (const auto [least, vision] = differenceOf(seen[i], seen[j]); least < wanted)
                pairs.push_back({among[i], among[j], vision, least});
        }
    std::ranges::stable_sort(pairs, {}, &AlikePair::difference);
    return pairs;
}

std::string alikeText(const TransferFunction& tf, const AlikePair& pair, double wanted) {
    return tf.features.at(pair.first).name + " and " + tf.features.at(pair.second).name + " look alike to " +
           viewerText(pair.vision) + " (ΔE00 " + fixedText(pair.difference, 1) + ", of " + plainText(wanted) +
           " wanted)";
}

std::optional<TransferFunction> withColorsApart(const TransferFunction& tf, const std::vector<std::size_t>& among,
                                                double wanted) {
    if (among.size() > kMostApart) return {};
    const std::vector<Rgb> all = featureColors(tf);
    std::vector<Rgb> colors;
    for (const std::size_t f : among) colors.push_back(all.at(f));
    Mending mending(colors, wanted + kRoundingMargin);
    if (mending.moveOneByOne())
        if (auto result = applied(tf, among, colors, mending.colors(), wanted)) return result;
    if (among.size() < 2) return {};
    mending.spreadLightness();
    if (!mending.moveOneByOne()) return {};
    return applied(tf, among, colors, mending.colors(), wanted);
}

} // namespace pellucid
