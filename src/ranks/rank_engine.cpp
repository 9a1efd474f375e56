#include "ranks/rank_engine.h"

#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "ranks/block_rays.h"
#include "ranks/depth_exchange.h"
#include "ranks/rank_volume.h"
#include "render/cpu/cpu_engine.h"
#include "render/cpu/sweep_run.h"
#include "render/cpu/sweep_volume.h"

namespace pellucid {

namespace {

class RankEngine final : public VisibilityEngine {
public:
    RankEngine(Communicator& ranks, BlockVolume own)
        : m_ranks(ranks), m_block(std::move(own)), m_runner(sweepKernels().front()) {
        const BlockVolume& block = m_block;
        PELLUCID_CHECK(static_cast<int>(block.blocks.blocks().size()) == ranks.size());
        if (!block.isEmpty()) m_volume.emplace(block.stored, block.whole, block.region.lo);
        // Tables depend on how many codes there are: where a rank has none it takes another's.
        SweepCodes codes;
        codes.max = 0;
        if (m_volume) codes = m_volume->codes();
        for (const SweepCodes& other : gatherValues(ranks, codes)) {
            if (codes.max == 0) codes.max = other.max;
            PELLUCID_CHECK(other.max == 0 || other.max == codes.max);
        }
        m_codes = codes;
    }

    std::string name() const override { return "cpu"; }
    const Volume& volume() const override {
        PELLUCID_CHECK(m_volume.has_value());
        return m_volume->stored();
    }

    std::vector<FeatureSums> sums(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights,
                                  const JobControl& job) override {
        return sumsByBatches(tfs, m_codes, weights, job, [&](const SweepTables& tables, const JobControl& part) {
            return sweep(view, tables, weights, nullptr, part);
        });
    }
    SumsJacobian jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                          const JobControl& job) override {
        return jacobianByBatches(tf, m_codes, weights, job, [&](const SweepTables& tables, const JobControl& part) {
            return sweep(view, tables, weights, nullptr, part);
        });
    }
    VisibilityField field(const View& view, const TransferFunction& tf, const JobControl& job) override {
        VisibilityField field{Grid<float>(m_block.isEmpty() ? Int3(0) : m_block.stored->dims())};
        sweep(view, SweepTables({&tf, 1}, m_codes), nullptr, &field.values, job);
        return field;
    }

private:
    std::vector<double> sweep(const View& view, const SweepTables& tables, const WeightFields* weights,
                              Grid<float>* field, const JobControl& job) {
        view.clipping.validate();
        const Camera camera = sweepCamera(view.camera, m_block.whole);
        const VoxelClipping clipping = clippingInVoxels(view.clipping, m_block.whole);
        const std::vector<int> order = sweepOrder(camera, m_block.whole, m_block.blocks);
        OpaqueMap opaque;
        if (m_volume) opaque = m_volume->opaqueMap(tables, clipping);
        std::vector<double> sums(tables.sumCount(), 0.0);
        const std::vector<SweepPass> passes = sweepPasses(camera, m_block.whole);
        for (std::size_t n = 0; n < passes.size(); ++n) {
            SweepInput in;
            if (m_volume) {
                in = m_volume->input(camera, clipping, passes[n], tables, opaque, weights, field);
            } else { // nothing to do, but where rays lie has to be known
                tables.giveTo(in);
                setSweepRays(in, camera, passes[n], m_block.whole, SweepCare::Large);
            }
            const auto layers = sweepLayers(in);
            for (std::size_t l = 0; l < layers.size(); ++l)
                sweepLayer(in, tables.usedLanes(), passes[n], layers[l], order, sums,
                           job.part(n * layers.size() + l, passes.size() * layers.size()));
        }
        m_ranks.sum(sums);
        return sums;
    }

    /// `lanes`: that are used. Carries rays through the block, asks what the others' blocks leave of their light, and
    /// measures the block's voxels of the layer.
    void sweepLayer(const SweepInput& pass, int lanes, const SweepPass& axes, const SweepLayer& layer,
                    const std::vector<int>& order, std::vector<double>& sums, const JobControl& job) {
        BlockRays rays = blockRays(pass, layer, axes, m_block.whole.dims, m_block.blocks, order, m_block.own);
        CarriedDepths carried;
        if (!isEmpty(m_block.block())) {
            SweepInput in = pass;
            in.bounded = true;
            in.keptLanes = lanes;
            in.reach = rays.reach;
            in.endRect = rays.carried.rect();
            in.carried = rays.carried.data();
            carried.through = RayDepths(in.endRect, lanes, 0);
            std::vector<SweepHandover> handovers;
            for (const BlockEntry& entry : rays.entries) {
                RayDepths depths(entry.rays, lanes, kNotHanded);
                handovers.push_back({entry.around, entry.rays, depths.values.data()}); // stays when depths move
                carried.handed.push_back({entry.block, std::move(depths)});
            }
            in.handovers = handovers.data();
            in.handoverCount = static_cast<int>(handovers.size());
            if (in.endRect.rays() > 0) {
                in.endDepths = carried.through.values.data();
                std::vector<double> none(sums.size(), 0.0);
                m_runner.run(in, sweepPieces(in, layer), none, job.part(0, 2));
            }
            carried.groups = std::move(rays.carried);
        }
        RayDepths before(rays.wanted, lanes, 0);
        SweepInput in = pass;
        in.window = rays.box;
        in.bounded = true;
        in.keptLanes = lanes;
        in.reach = rays.around;
        begin(in, layer, before);
        in.startRect = before.rect;
        in.startDepths = before.values.data();
        std::vector<SweepPiece> pieces;
        if (rays.wanted.rays() > 0) pieces = sweepPieces(in, layer);
        std::vector<std::vector<double>> ofPieces(pieces.size());
        const auto run = [&](std::span<const std::size_t> which, const JobControl& part) {
            m_runner.runSome(in, pieces, which, sums.size(), ofPieces, part);
        };
        // What no other block has a say in is measured while those are waited for.
        std::vector<std::size_t> left;
        for (std::size_t i = 0; i < pieces.size(); ++i) left.push_back(i);
        const auto unbound = std::stable_partition(left.begin(), left.end(), [&](std::size_t i) {
            return std::ranges::any_of(rays.entering, [&](const SweepRect& entering) {
                return pieces[i].firstRow < entering.endRow && pieces[i].lastRow >= entering.firstRow;
            });
        });
        auto free = static_cast<std::size_t>(left.end() - unbound);
        m_ranks.await([&] {
            const std::size_t some = std::min(free, static_cast<std::size_t>(threadCount()));
            run(std::span(left).last(some), {job.stop, {}});
            left.resize(left.size() - some);
            free -= some;
            return some > 0;
        });
        findDepthsBefore(m_ranks, order, rays.all, std::move(carried), before);
        run(left, job.part(1, 2));
        addUp(ofPieces, sums);
    }

    /// What rays have met that nobody hands over: they come from outside the volume, or never come here.
    static void begin(const SweepInput& in, const SweepLayer& layer, RayDepths& depths) {
        const SweepRect& rect = depths.rect;
        for (int row = rect.firstRow; row < rect.endRow; ++row) {
            RaySpan span = raysThrough(in, layer, in.reach, row, rect);
            while (span.first < span.end && !passes(in, layer, span.first, row, in.reach)) ++span.first;
            while (span.first < span.end && !passes(in, layer, span.end - 1, row, in.reach)) --span.end;
            if (span.first >= span.end) span = {rect.endCol, rect.endCol};
            const auto at = [&](int col) {
                return depths.values.begin() + static_cast<std::ptrdiff_t>(rect.at(col, row, depths.lanes));
            };
            std::fill(at(rect.firstCol), at(span.first), kUnknownDepth); // those in between keep 0
            std::fill(at(span.end), at(rect.endCol), kUnknownDepth);
        }
    }

    Communicator& m_ranks;
    BlockVolume m_block;
    std::optional<SweepVolume> m_volume; ///< empty where the rank has no block
    SweepCodes m_codes;
    SweepRunner m_runner;
};

} // namespace

std::unique_ptr<VisibilityEngine> makeRankEngine(Communicator& ranks, BlockVolume block) {
    return std::make_unique<RankEngine>(ranks, std::move(block));
}

namespace {

/// Every size()-th piece of a sweep is this rank's.
PieceShare shareOf(Communicator& ranks) {
    const auto part = static_cast<std::size_t>(ranks.rank()), parts = static_cast<std::size_t>(ranks.size());
    return {part, parts, [&ranks, part, parts](std::vector<std::vector<double>>& sums, std::size_t size) {
                std::vector<double> mine;
                for (std::size_t i = part; i < sums.size(); i += parts)
                    mine.insert(mine.end(), sums[i].begin(), sums[i].end());
                const auto all = ranks.gather(std::as_bytes(std::span(mine)));
                const std::size_t bytes = size * sizeof(double);
                for (std::size_t i = 0; i < sums.size(); ++i) {
                    sums[i].resize(size);
                    std::memcpy(sums[i].data(), all[i % parts].data() + i / parts * bytes, bytes);
                }
            }};
}

} // namespace

std::unique_ptr<VisibilityEngine> makeEngineOnRanks(Communicator& ranks, std::shared_ptr<const Volume> volume,
                                                    Quality quality) {
    const auto* blocks = dynamic_cast<const RankVoxels*>(volume->elsewhere());
    if (blocks == nullptr) return makeCpuEngine(std::move(volume), quality, sweepKernels().front(), shareOf(ranks));
    if (quality == Quality::High)
        throw UsageError("quality high follows lines through the whole volume, whose blocks lie on several ranks",
                         "--quality", "leave it out, or use pellucid-cli");
    return makeRankEngine(blocks->ranks(), blocks->blockOf(*volume));
}

} // namespace pellucid
