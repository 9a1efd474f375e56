// The fast engine: runs the pieces of sweeps (see sweep.h) on threads.
#include <algorithm>

#include "render/cpu/cpu_engine.h"
#include "render/cpu/sweep_run.h"
#include "render/cpu/sweep_volume.h"

namespace pellucid {

namespace {

class CpuEngine final : public VisibilityEngine {
public:
    CpuEngine(std::shared_ptr<const Volume> volume, Quality quality, SweepKernel kernel, bool draft = false,
              PieceShare share = {})
        : m_volume(std::move(volume), quality, draft), m_runner(kernel, std::move(share)) {}

    std::string name() const override { return "cpu"; }
    const Volume& volume() const override { return m_volume.stored(); }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        return sumsByBatches(tfs, m_volume.codes(), weights, job,
                             [&](const SweepTables& tables, const JobControl& part) {
                                 return sweep(view, tables, weights, nullptr, part);
                             });
    }
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        return jacobianByBatches(tf, m_volume.codes(), weights, job,
                                 [&](const SweepTables& tables, const JobControl& part) {
                                     return sweep(view, tables, weights, nullptr, part);
                                 });
    }
    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        VisibilityField field{Grid<float>(volume().dims())};
        sweep(view, SweepTables({&tf, 1}, m_volume.codes()), nullptr, &field.values, job);
        return field;
    }

private:
    /// The kernel's sums, over all passes.
    std::vector<double> sweep(const View& view, const SweepTables& tables, const WeightFields* weights,
                              Grid<float>* field, const JobControl& job) {
        view.clipping.validate();
        const Camera camera = sweepCamera(view.camera, m_volume.geometry());
        const VoxelClipping clipping = clippingInVoxels(view.clipping, m_volume.geometry());
        OpaqueMap opaque = m_volume.opaqueMap(tables, clipping);
        const std::vector<SweepPass> passes = sweepPasses(camera, m_volume.geometry());
        std::vector<double> sums(tables.sumCount(), 0.0);
        for (std::size_t n = 0; n < passes.size(); ++n) {
            const SweepInput in = m_volume.input(camera, clipping, passes[n], tables, opaque, weights, field);
            m_runner.run(in, sweepPieces(in), sums, job.part(n, passes.size()));
        }
        return sums;
    }

    SweepVolume m_volume;
    SweepRunner m_runner;
};

} // namespace

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return makeCpuEngine(std::move(volume), quality, sweepKernels().front());
}

std::unique_ptr<VisibilityEngine> makeCpuEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                SweepKernel kernel, PieceShare share) {
    return std::make_unique<CpuEngine>(std::move(volume), quality, kernel, false, std::move(share));
}

FeatureSums featureSumsOf(std::span<const double> totals, std::size_t features, std::size_t lane, std::size_t lanes,
                          const WeightFields* weights) {
    FeatureSums sums = emptySums(features);
    for (std::size_t f = 0; f <= features; ++f) {
        const double* item = &totals[f * 3 * lanes + lane];
        sums.allVisibility += item[0];
        if (f < features) sums.visibility[f] = item[0];
        for (std::size_t w = 0; w < 2; ++w) {
            const double scale = weights != nullptr ? static_cast<double>(weights->scale(static_cast<int>(w))) : 0;
            const double weighted = item[(w + 1) * lanes] * scale;
            sums.allWeighted[w] += weighted;
            if (f < features) sums.weighted[w][f] = weighted;
        }
    }
    return sums;
}

std::unique_ptr<VisibilityEngine> makeDraftEngine(std::shared_ptr<const Volume> volume) {
    return std::make_unique<CpuEngine>(std::move(volume), Quality::Normal, sweepKernels().front(), true);
}

} // namespace pellucid
