// makeGlEngine: the VisibilityEngine on OpenGL; sweep_device.h does the work in the context.
#include "render/gl/visibility_gl.h"
#include "render/gl/gl_engines.h"
#include "render/gl/headless_context.h"
#include "render/gl/sweep_device.h"

namespace pellucid {

namespace {

class GlEngine final : public VisibilityEngine {
public:
    GlEngine(std::shared_ptr<const Volume> volume, Quality quality, const gl::VisibilityBudget& budget)
        : m_volume(std::move(volume)), m_quality(quality), m_codes(sharedIntensityGrid(*m_volume)), m_grid(*m_codes),
          m_cells(gl::tableCells(*m_volume, quality)) {
        m_device.emplace([&] { return std::make_unique<gl::SweepDevice>(m_grid, budget); });
    }

    std::string name() const override { return "gl"; }
    const Volume& volume() const override { return *m_volume; }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override;
    /// The device has no derivative sweep: the cpu engine answers, on the same volume.
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        if (!m_cpu) m_cpu = makeCpuEngine(m_volume, m_quality);
        return m_cpu->jacobian(view, tf, weights, job);
    }
    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override;

private:
    std::shared_ptr<const Volume> m_volume;
    Quality m_quality;
    std::shared_ptr<const IntensityGrid> m_codes;
    const IntensityGrid& m_grid;
    int m_cells;
    gl::InContext<gl::SweepDevice> m_device;
    std::unique_ptr<VisibilityEngine> m_cpu; ///< made when first needed
};

std::vector<FeatureSums> GlEngine::sums(const View& view, std::span<const TransferFunction> tfs,
                                        const WeightFields* weights, const JobControl& job) {
    const Camera& camera = view.camera;
    camera.validate(m_volume->geometry(), "camera");
    view.clipping.validate();
    if (tfs.empty()) return {};
    const std::vector<Feature>& features = tfs.front().features;
    for (const TransferFunction& tf : tfs) PELLUCID_CHECK(tf.features == features);
    if (weights != nullptr) PELLUCID_CHECK(weights->dims() == m_volume->dims());

    gl::SweepRequest request;
    request.sweeps = gl::makeSweeps(view, m_volume->geometry(), m_quality);
    request.eyeInVoxels = m_volume->geometry().voxelFromWorld(camera.eye);
    request.slotOfCode = gl::slotsOfCodes(m_grid, features);
    request.features = static_cast<int>(features.size());
    if (weights != nullptr) {
        request.weights = weights;
        request.weightsKey = gl::keyOf(*weights);
    }
    int atOnce = 0;
    m_device.run([&](gl::SweepDevice& device) { atOnce = device.candidatesAtOnce(request); });

    const std::size_t size = static_cast<std::size_t>(atOnce), groups = (tfs.size() + size - 1) / size;
    std::vector<FeatureSums> results;
    while (results.size() < tfs.size()) {
        const std::size_t first = results.size();
        const auto group = tfs.subspan(first, std::min(size, tfs.size() - first));
        const int lanes = group.size() == 1 ? 1 : group.size() <= 4 ? 4 : 8;
        request.tables = gl::makeDepthTables(group, lanes, m_cells);
        std::vector<double> totals;
        m_device.run([&](gl::SweepDevice& device) { totals = device.sums(request, job.part(first / size, groups)); });

        for (std::size_t lane = 0; lane < group.size(); ++lane)
            results.push_back(
                gl::featureSumsOf(totals, features.size(), lane, static_cast<std::size_t>(lanes), weights));
    }
    job.report(1.0);
    return results;
}

VisibilityField GlEngine::field(const View& view, const TransferFunction& tf, const JobControl& job) {
    const Camera& camera = view.camera;
    camera.validate(m_volume->geometry(), "camera");
    view.clipping.validate();
    gl::SweepRequest request;
    request.sweeps = gl::makeSweeps(view, m_volume->geometry(), m_quality);
    request.eyeInVoxels = m_volume->geometry().voxelFromWorld(camera.eye);
    request.tables = gl::makeDepthTables({&tf, 1}, 1, m_cells);
    VisibilityField result{Grid<float>(m_volume->dims())};
    const auto store = [&](const gl::SweptPlanes& planes) {
        const auto stride = planes.sweep.strides();
        const float* v = planes.values.data();
        for (int c = planes.first; c < planes.end; ++c)
            for (int b = 0; b < planes.sweep.dims.y; ++b)
                for (int a = 0; a < planes.sweep.dims.x; ++a, ++v) // 0 but in the one sweep the voxel belongs to
                    result.values[static_cast<std::size_t>(stride.base + a * stride.a + b * stride.b + c * stride.c)] +=
                        *v;
    };
    m_device.run([&](gl::SweepDevice& device) { device.field(request, job, store); });
    job.report(1.0);
    return result;
}

} // namespace

std::unique_ptr<VisibilityEngine> makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality) {
    return gl::makeGlEngine(std::move(volume), quality, gl::VisibilityBudget{});
}

std::unique_ptr<VisibilityEngine> gl::makeGlEngine(std::shared_ptr<const Volume> volume, Quality quality,
                                                   const VisibilityBudget& budget) {
    return std::make_unique<GlEngine>(std::move(volume), quality, budget);
}

} // namespace pellucid
