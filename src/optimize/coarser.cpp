#include "optimize/coarser.h"

#include <algorithm>
#include <bit>

#include <glm/common.hpp>

#include "base/parallel.h"
#include "volume/excerpt.h"

namespace pellucid {

namespace {

Int3 halvingFactors(const Geometry& g) {
    const double least = std::min(g.spacing.x, std::min(g.spacing.y, g.spacing.z));
    Int3 factors(1);
    for (int a = 0; a < 3; ++a)
        if (g.spacing[a] < 1.5 * least && g.dims[a] > 1) factors[a] = 2;
    return factors;
}

ExcerptPlan planOf(const Volume& volume) {
    ExcerptPlan plan;
    plan.region = {Int3(0), volume.dims()};
    plan.factors = halvingFactors(volume.geometry());
    plan.dims = (volume.dims() - 1) / plan.factors + 1;
    plan.excerpt = {volume.dims(), plan.region, 2, false};
    return plan;
}

} // namespace

std::shared_ptr<const Volume> halved(const Volume& volume, const JobControl& job) {
    ExcerptPlan plan = planOf(volume);
    plan.referenceLength = volume.geometry().d0();
    Volume coarse = excerptOf(volume, plan, job);
    coarse.excerpt.reset(); // nobody sees it: there is nothing to tell
    coarse.notices.clear();
    return std::make_shared<const Volume>(std::move(coarse));
}

WeightFields halvedWeights(const WeightFields& weights, const Volume& volume, const JobControl& job) {
    const ExcerptPlan plan = planOf(volume);
    const Int3 full = weights.dims(), dims = plan.dims;
    const float brightest = weights.scale(0) * 65535.0f, most = weights.scale(1) * 65535.0f;
    WeightFields coarse(dims, brightest, most);
    const auto at = [](const Int3& size, int i, int j, int k) {
        return static_cast<std::size_t>(i) +
               static_cast<std::size_t>(size.x) *
                   (static_cast<std::size_t>(j) + static_cast<std::size_t>(size.y) * static_cast<std::size_t>(k));
    };
    parallelFor(static_cast<std::size_t>(dims.z), [&](std::size_t layer) {
        job.throwIfStopped();
        const int k = static_cast<int>(layer);
        const auto width = static_cast<std::size_t>(full.x);
        std::vector<std::uint32_t> brightness(width), saturation(width), row(static_cast<std::size_t>(dims.x));
        for (int j = 0; j < dims.y; ++j) {
            const Int3 lo = Int3(0, j, k) * plan.factors, hi = glm::min(lo + plan.factors, full);
            std::fill(brightness.begin(), brightness.end(), 0u);
            std::fill(saturation.begin(), saturation.end(), 0u);
            for (int z = lo.z; z < hi.z; ++z)
                for (int y = lo.y; y < hi.y; ++y) {
                    const std::size_t first = at(full, 0, y, z);
                    for (std::size_t i = 0; i < width; ++i) {
                        const std::uint32_t units = weights.units(first + i);
                        brightness[i] += units & 0xffffu;
                        saturation[i] += units >> 16;
                    }
                }
            // Factors are 1 or 2, so that a mean is of 1, 2, 4 or 8 and its division a shift.
            const int rows = (hi.z - lo.z) * (hi.y - lo.y);
            for (int i = 0; i < dims.x; ++i) {
                const int from = i * plan.factors.x, to = std::min(from + plan.factors.x, full.x);
                std::uint32_t b = 0, s = 0;
                for (auto x = static_cast<std::size_t>(from); x < static_cast<std::size_t>(to); ++x) {
                    b += brightness[x];
                    s += saturation[x];
                }
                const auto count = static_cast<unsigned>(rows * (to - from));
                const int shift = std::countr_zero(count);
                row[static_cast<std::size_t>(i)] = (b + count / 2) >> shift | (s + count / 2) >> shift << 16;
            }
            coarse.store(at(dims, 0, j, k), row.data(), row.size());
        }
    });
    return coarse;
}

CoarserVolumes::CoarserVolumes(std::shared_ptr<const Volume> volume, const MakeEngine& make, const JobControl& job)
    : m_full(std::move(volume)) {
    const auto add = [&](std::shared_ptr<const Volume> copy) {
        job.throwIfStopped();
        m_levels.push_back({copy, make(copy), {}});
    };
    if (m_full->size() < kSampledFinely) add(m_full);
    const Volume* finer = m_full.get();
    while (finer->size() > kSmallest && m_levels.size() < kMost) {
        add(halved(*finer, job));
        finer = m_levels.back().volume.get();
    }
}

void CoarserVolumes::setWeights(const WeightFields& weights, const JobControl& job) {
    m_weights = &weights;
    const WeightFields* finer = &weights;
    const Volume* volume = m_full.get();
    for (Level& level : m_levels) {
        if (level.volume == m_full) continue;
        level.weights = halvedWeights(*finer, *volume, job);
        finer = &level.weights;
        volume = level.volume.get();
    }
}

std::vector<std::unique_ptr<VwsFunction>> CoarserVolumes::functions(const View& view, const TransferFunction& base,
                                                                    const VwsOptions& options) const {
    std::vector<std::unique_ptr<VwsFunction>> all;
    for (const Level& level : m_levels)
        all.push_back(std::make_unique<EngineVws>(*level.engine, view, base,
                                                  level.volume == m_full ? *m_weights : level.weights, options));
    return all;
}

} // namespace pellucid
