#include "optimize/ray_bundle.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "optimize/bin_sampler.h"
#include "tf/opacity.h"

namespace pellucid {

namespace {

constexpr int kLanes = 8;      // transfer functions that are looked at together
constexpr double kMeets = 0.5; // d0 of path through a feature
constexpr double kSolid = 0.95, kEmpty = 0.05;

} // namespace

RayBundle::RayBundle(const Volume& volume, const TransferFunction& tf, const View& view, int pixels,
                     const JobControl& job)
    : m_features(tf.features.size()) {
    const BinFeatures features(tf);
    m_slotOfBin = features.slot;
    m_stepInD0 = stepAlongRays(volume.geometry());
    const double step = m_stepInD0 * volume.geometry().d0();

    struct Step {
        std::uint16_t step, bin;
    };
    std::vector<std::vector<Step>> rows(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
    forEachRay(volume, view, pixels, {0, pixels}, step, 1, job,
               [&](std::size_t pixel, const PixelRay& r, const auto& sampler) {
                   std::uint16_t n = 0;
                   for (double t = r.first; t < r.exit; t += step, ++n) {
                       const Vec3 at = r.ray.origin + t * r.ray.direction;
                       if (!sampler.answersFor(at)) continue;
                       if (const int bin = sampler.at(at); bin >= 0 && features.keeps(bin))
                           rows[pixel].push_back({n, static_cast<std::uint16_t>(bin)});
                   }
               });
    shareRays(volume, rows);

    m_begins.push_back(0);
    for (const std::vector<Step>& row : rows) {
        std::vector<int> steps(m_features + 1, 0);
        for (const Step& met : row) ++steps[static_cast<std::size_t>(m_slotOfBin[met.bin])];
        steps.pop_back(); // of what is in no feature
        const auto met = [&](int n) { return n * m_stepInD0 >= kMeets; };
        if (std::ranges::none_of(steps, met)) continue;
        for (const Step& one : row) m_bins.push_back(one.bin);
        m_begins.push_back(static_cast<std::uint32_t>(m_bins.size()));
        for (const int n : steps) m_met.push_back(met(n));
    }
}

int RayBundle::raysOf(int feature) const {
    int count = 0;
    for (int r = 0; r < rays(); ++r) count += meets(r, feature);
    return count;
}

std::vector<RayBundle::Appearance> RayBundle::appearances(const std::vector<TransferFunction>& tfs,
                                                          const std::vector<char>& wanted, int every) const {
    std::vector<Appearance> all(tfs.size());
    const auto stride = static_cast<std::size_t>(every);
    const std::size_t rayCount = (static_cast<std::size_t>(rays()) + stride - 1) / stride;
    const auto counts = [&](std::size_t ray) { // towards alpha
        if (wanted.empty()) return true;
        for (std::size_t f = 0; f < m_features; ++f)
            if (wanted[f] && m_met[ray * m_features + f]) return true;
        return false;
    };
    for (std::size_t first = 0; first < tfs.size(); first += kLanes) {
        const std::size_t lanes = std::min<std::size_t>(kLanes, tfs.size() - first);
        std::vector<std::array<float, kLanes>> opacity(kIntensityBins, std::array<float, kLanes>{});
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const TfSampler sampler(tfs[first + lane]);
            for (int bin = 0; bin < kIntensityBins; ++bin)
                opacity[static_cast<std::size_t>(bin)][lane] =
                    static_cast<float>(opacityOfStep(sampler.opacity(intensityOfBin(bin)), m_stepInD0));
        }
        // A slot per block of rays, added in order: the same bits for any number of threads.
        struct Sums {
            std::vector<std::array<double, kLanes>> features;
            std::vector<int> met;
            std::array<double, kLanes> alpha{}, allAlpha{}, translucent{};
            int counted = 0;
        };
        constexpr std::size_t kBlock = 128;
        std::vector<Sums> blocks((rayCount + kBlock - 1) / kBlock);
        parallelFor(blocks.size(), [&](std::size_t b) {
            Sums& sums = blocks[b];
            sums.features.assign(m_features, {});
            sums.met.assign(m_features, 0);
            std::vector<std::array<float, kLanes>> parts(m_features + 1);
            for (std::size_t n = b * kBlock; n < std::min(rayCount, (b + 1) * kBlock); ++n) {
                const std::size_t ray = n * stride;
                parts.assign(m_features + 1, {});
                std::array<float, kLanes> light;
                light.fill(1.0f);
                for (std::uint32_t i = m_begins[ray]; i < m_begins[ray + 1]; ++i) {
                    const auto& a = opacity[m_bins[i]];
                    auto& part = parts[static_cast<std::size_t>(m_slotOfBin[m_bins[i]])];
                    for (std::size_t lane = 0; lane < kLanes; ++lane) {
                        const float v = light[lane] * a[lane];
                        part[lane] += v;
                        light[lane] -= v;
                    }
                }
                const bool counted = counts(ray);
                sums.counted += counted;
                for (std::size_t f = 0; f < m_features; ++f) sums.met[f] += m_met[ray * m_features + f];
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    for (std::size_t f = 0; f < m_features; ++f)
                        sums.features[f][lane] += static_cast<double>(parts[f][lane]);
                    const double alpha = 1.0 - static_cast<double>(light[lane]);
                    sums.allAlpha[lane] += alpha;
                    if (!counted) continue;
                    sums.alpha[lane] += alpha;
                    sums.translucent[lane] += alpha > kEmpty && alpha < kSolid;
                }
            }
        });
        std::vector<int> met(m_features, 0);
        int counted = 0;
        for (const Sums& sums : blocks) {
            counted += sums.counted;
            for (std::size_t f = 0; f < m_features; ++f) met[f] += sums.met[f];
        }
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            Appearance& a = all[first + lane];
            a.covers.assign(m_features, 0.0);
            double alphaOfAll = 0;
            for (const Sums& sums : blocks) {
                for (std::size_t f = 0; f < m_features; ++f) a.covers[f] += sums.features[f][lane];
                alphaOfAll += sums.allAlpha[lane];
                a.alpha += sums.alpha[lane];
                a.translucent += sums.translucent[lane];
            }
            a.shares.assign(m_features, 0.0);
            for (std::size_t f = 0; f < m_features; ++f) {
                if (alphaOfAll > 0) a.shares[f] = a.covers[f] / alphaOfAll;
                a.covers[f] /= std::max(1, met[f]);
            }
            a.alpha /= std::max(1, counted);
            a.translucent /= std::max(1, counted);
        }
    }
    return all;
}

} // namespace pellucid
