#include "render/probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

#include "render/trilinear.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr int kStepsPerD0 = 8;     ///< first; they are halved
constexpr int kMostHalvings = 5;   ///< so often at most
constexpr double kStraight = 1e-4; ///< until the middle is no farther than this off the straight line
constexpr int kStepsPerSample = 4; ///< one of so many is kept for the profile
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Nodes and weights of Gauss and Legendre on [0, 1].
constexpr std::array<std::array<double, 2>, 3> kGauss{
    {{0.11270166537925831, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074169, 5.0 / 18}}};

/// The mean of −ln(1 − α) while α goes from a to b along a straight line; empty where it is so nearly straight itself
/// that a quadrature tells it better.
std::optional<double> meanDepth(double a, double b) {
    a = std::clamp(a, 0.0, kMaxOpacity), b = std::clamp(b, 0.0, kMaxOpacity);
    if (std::abs(b - a) < 0.01 * (1 - std::max(a, b))) return {};
    const auto integral = [](double alpha) { return (1 - alpha) * std::log1p(-alpha) + alpha; };
    return (integral(b) - integral(a)) / (b - a);
}

/// Goes along the ray from entry to exit and adds up what it meets.
class Walk {
public:
    Walk(const TransferFunction& tf, double d0, int only, RayProbe& result)
        : m_tf(tf), m_sampler(tf), m_d0(d0), m_only(only), m_result(result), m_most(tf.features.size() + 1) {
        for (const ControlPoint& p : tf.points) m_cuts.push_back(p.x);
        for (const Feature& f : tf.features) m_cuts.insert(m_cuts.end(), {f.a, f.b});
        std::ranges::sort(m_cuts);
        m_cuts.erase(std::unique(m_cuts.begin(), m_cuts.end()), m_cuts.end());
        m_result.shares.assign(tf.features.size(), 0);
    }

    /// From t to t + length, in steps along which the intensity goes straight; `metAfter(t)` tells what is between.
    template <class MetAfter>
    void between(double t, double length, const Interpolated& from, const Interpolated& to, const MetAfter& metAfter,
                 int halvings) {
        const Interpolated middle = halvings > 0 ? metAfter(t + length / 2) : Interpolated{};
        const auto isOff = [](double a, double m, double b) { return std::abs(m - (a + b) / 2) > kStraight; };
        if (halvings == 0 ||
            (!isOff(from.value, middle.value, to.value) && !isOff(from.validShare, middle.validShare, to.validShare))) {
            step(t, length, from, to);
            return;
        }
        between(t, length / 2, from, middle, metAfter, halvings - 1);
        between(t + length / 2, length / 2, middle, to, metAfter, halvings - 1);
    }

    /// What follows is faint: in no feature, its optical depth that part of its own.
    void enterFaint(double density) { m_faint = density; }
    void leaveFaint() { m_faint.reset(); }

    void sample(double t, const Interpolated& met) {
        m_result.samples.push_back({t, met.validShare > 0 ? met.value : kNone, -std::expm1(-m_depth)});
    }

    void finish() {
        m_result.alpha = -std::expm1(-m_depth);
        if (m_result.alpha > 0) {
            const Vec3 straight = m_color / m_result.alpha;
            m_result.color = {straight.r, straight.g, straight.b};
        }
        double largest = 0;
        for (std::size_t f = 0; f < m_result.shares.size(); ++f) {
            if (m_result.shares[f] <= largest) continue;
            largest = m_result.shares[f];
            m_result.feature = static_cast<int>(f);
        }
        const Most& most = m_most[static_cast<std::size_t>(m_result.feature + 1)];
        m_result.t = most.t;
        m_result.intensity = most.intensity;
    }

private:
    /// Where a feature adds most.
    struct Most {
        double perLength = 0, t = 0, intensity = kNone;
    };

    /// From t to t + length, where the intensity goes from `from` to `to` along a straight line.
    void step(double t, double length, Interpolated from, Interpolated to) {
        if (from.validShare == 0) from.value = to.value;
        if (to.validShare == 0) to.value = from.value;
        // Pieces that no control point and no border of a feature divides.
        const double lo = std::min(from.value, to.value), hi = std::max(from.value, to.value);
        auto first = std::ranges::upper_bound(m_cuts, lo);
        auto last = std::lower_bound(first, m_cuts.end(), hi);
        double begin = 0;
        const auto until = [&](double cut) {
            const double end = (cut - from.value) / (to.value - from.value);
            piece(t, length, from, to, begin, end);
            begin = end;
        };
        if (from.value < to.value)
            for (; first < last; ++first) until(*first);
        else
            for (; first < last; --last) until(*(last - 1));
        piece(t, length, from, to, begin, 1);
    }

    void piece(double t, double length, const Interpolated& from, const Interpolated& to, double begin, double end) {
        if (!(begin < end)) return;
        const auto mix = [](double a, double b, double f) { return a + f * (b - a); };
        const double middle = mix(from.value, to.value, (begin + end) / 2);
        const int drawn = featureAt(m_tf.features, middle), feature = m_faint ? -1 : drawn;
        double tau = 0, valid = 0; // τ·d0, and the same where voxels are valid
        Vec3 emitted(0);
        if (m_only < 0 || drawn == m_only)
            for (const auto& [node, weight] : kGauss) {
                const double u = mix(begin, end, node), s = mix(from.value, to.value, u);
                const double here = weight * opticalDepthOfOpacity(m_sampler.opacity(s));
                if (here == 0) continue;
                tau += here;
                const double there = here * mix(from.validShare, to.validShare, u);
                valid += there;
                const Rgb c = m_sampler.color(s);
                emitted += there * Vec3(c.r, c.g, c.b);
            }
        const double own = (end - begin) * length;
        double opticalDepth = 0;
        if (valid > 0) {
            // The sides of the piece, where there may be a step of α, are met from its inside.
            const double a = m_sampler.opacity(mix(from.value, to.value, mix(begin, end, 0.25))),
                         b = m_sampler.opacity(mix(from.value, to.value, mix(begin, end, 0.75)));
            opticalDepth = valid / tau * meanDepth(a + (a - b) / 2, b + (b - a) / 2).value_or(tau) * own / m_d0;
            opticalDepth *= m_faint.value_or(1);
        }
        const double share = std::exp(-m_depth) * -std::expm1(-opticalDepth);
        if (share > 0) m_color += share * emitted / valid;
        m_depth += opticalDepth;

        if (m_result.runs.empty() || m_result.runs.back().feature != feature)
            m_result.runs.push_back({t + begin * length, 0, feature, 0, 0});
        ProbeRun& run = m_result.runs.back();
        run.end = t + end * length;
        run.opticalDepth += opticalDepth;
        run.share += share;
        (feature >= 0 ? m_result.shares[static_cast<std::size_t>(feature)] : m_result.rest) += share;
        Most& most = m_most[static_cast<std::size_t>(feature + 1)];
        if (share / own > most.perLength) most = {share / own, t + (begin + end) / 2 * length, middle};
    }

    const TransferFunction& m_tf;
    TfSampler m_sampler;
    double m_d0;
    int m_only;
    RayProbe& m_result;
    std::vector<double> m_cuts;    ///< intensities where α or the feature changes its ways, ascending
    std::optional<double> m_faint; ///< empty: it is not
    double m_depth = 0;
    Vec3 m_color{0};
    std::vector<Most> m_most; ///< the rest, then each feature
};

} // namespace

Vec3 RayProbe::at(double length) const {
    const double whole = glm::length(exit - entry);
    return whole > 0 ? entry + (length / whole) * (exit - entry) : entry;
}

RayProbe probe(const Volume& volume, const TransferFunction& tf, const View& view, double x, double y, int width,
               int height, int onlyFeature) {
    const Geometry& g = volume.geometry();
    view.camera.validate(g, "camera");
    view.clipping.validate();
    RayProbe result;
    result.intensity = kNone;
    result.shares.assign(tf.features.size(), 0);
    const Ray world = pixelRay(view.camera, x, y, width, height), ray = inVoxels(world, g);
    RayInterval inside = intersectBox(ray, g);
    if (view.camera.projection == Projection::Perspective) inside.enter = std::max(inside.enter, 0.0);
    const VoxelClipping clipping = clippingInVoxels(view.clipping, g);
    cut(inside, ray, clipping.cut);
    RayInterval clear = inside;
    cut(clear, ray, clipping.faint);
    if (clipping.density == 0) inside = clear;
    if (inside.empty()) return result;
    if (clear.empty()) clear.enter = clear.exit = inside.exit;
    result.hit = true;
    result.entry = world.origin + inside.enter * world.direction;
    result.exit = world.origin + inside.exit * world.direction;

    const double ends[4] = {0, clear.enter - inside.enter, clear.exit - inside.enter, inside.exit - inside.enter};
    Walk walk(tf, g.d0(), onlyFeature, result);
    std::visit(
        [&](const auto& values) {
            const auto metAfter = [&](double t) {
                return interpolateValid(
                    [&](std::size_t i) { return volume.intensityOfValue(static_cast<double>(values[i])); },
                    volume.dims(), ray.origin + (inside.enter + t) * ray.direction);
            };
            Interpolated from = metAfter(0);
            walk.sample(0, from);
            for (int part = 0; part < 3; ++part) { // faint, not, faint
                const double length = ends[part + 1] - ends[part];
                if (!(length > 0)) continue;
                if (part == 1)
                    walk.leaveFaint();
                else
                    walk.enterFaint(clipping.density);
                const auto steps = static_cast<std::size_t>(std::ceil(length / g.d0() * kStepsPerD0));
                const double step = length / static_cast<double>(steps);
                for (std::size_t n = 0; n < steps; ++n) {
                    const double t = ends[part] + static_cast<double>(n) * step;
                    const Interpolated to = metAfter(t + step);
                    walk.between(t, step, from, to, metAfter, kMostHalvings);
                    if ((n + 1) % kStepsPerSample == 0 || n + 1 == steps) walk.sample(t + step, to);
                    from = to;
                }
            }
        },
        volume.samples());
    walk.finish();
    result.position = result.at(result.t);
    return result;
}

std::vector<double> depthInFront(const RayProbe& probe, std::size_t feature) {
    std::vector<double> depths(probe.shares.size(), 0);
    const auto less = [](const ProbeRun& a, const ProbeRun& b) {
        return a.share != b.share ? a.share < b.share : a.opticalDepth < b.opticalDepth;
    };
    const ProbeRun* main = nullptr;
    for (const ProbeRun& run : probe.runs)
        if (run.feature == static_cast<int>(feature) && (main == nullptr || less(*main, run))) main = &run;
    if (main == nullptr) return depths;
    for (const ProbeRun* run = probe.runs.data(); run != main; ++run)
        if (run->feature >= 0 && run->feature != main->feature)
            depths[static_cast<std::size_t>(run->feature)] += run->opticalDepth;
    return depths;
}

} // namespace pellucid
