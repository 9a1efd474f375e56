#include "render/cpu/sweep_run.h"

#include <algorithm>
#include <atomic>

#include "base/check.h"
#include "base/parallel.h"
#include "render/cpu/cpu_engine.h"

namespace pellucid {

void SweepRunner::run(const SweepInput& in, const std::vector<SweepPiece>& pieces, std::vector<double>& sums,
                      const JobControl& job) {
    const bool shared = m_share.complete && in.field == nullptr; // a field is made by all
    std::vector<std::size_t> mine;
    for (std::size_t i = shared ? m_share.part : 0; i < pieces.size(); i += shared ? m_share.parts : 1)
        mine.push_back(i);
    std::vector<std::vector<double>> ofPieces(pieces.size());
    runSome(in, pieces, mine, sums.size(), ofPieces, job);
    if (shared && !pieces.empty()) m_share.complete(ofPieces, sums.size());
    addUp(ofPieces, sums);
}

void SweepRunner::runSome(const SweepInput& in, const std::vector<SweepPiece>& pieces,
                          std::span<const std::size_t> which, std::size_t size,
                          std::vector<std::vector<double>>& ofPieces, const JobControl& job) {
    std::atomic<std::size_t> done = 0;
    parallelFor(which.size(), [&](std::size_t n) {
        job.throwIfStopped();
        std::vector<double>& sums = ofPieces[which[n]];
        sums.assign(size, 0.0);
        const auto scratch = borrowScratch();
        m_kernel(in, pieces[which[n]], *scratch, sums.data());
        returnScratch(scratch);
        job.report(static_cast<double>(++done) / static_cast<double>(which.size()));
    });
}

void addUp(const std::vector<std::vector<double>>& ofPieces, std::vector<double>& sums) {
    for (const auto& piece : ofPieces)
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += piece[i];
}

std::shared_ptr<SweepScratch> SweepRunner::borrowScratch() {
    std::lock_guard lock(m_mutex);
    if (m_scratch.empty()) return std::make_shared<SweepScratch>();
    auto scratch = m_scratch.back();
    m_scratch.pop_back();
    return scratch;
}

void SweepRunner::returnScratch(std::shared_ptr<SweepScratch> scratch) {
    std::lock_guard lock(m_mutex);
    m_scratch.push_back(std::move(scratch));
}

std::vector<FeatureSums> sumsByBatches(std::span<const TransferFunction> tfs, const SweepCodes& codes,
                                       const WeightFields* weights, const JobControl& job, const SweepOnce& sweep) {
    std::vector<FeatureSums> all;
    for (const TransferFunction& tf : tfs) PELLUCID_CHECK(tf.features == tfs[0].features);
    const std::size_t batches = (tfs.size() + kSweepLanes - 1) / kSweepLanes;
    for (std::size_t first = 0; first < tfs.size(); first += kSweepLanes) {
        const auto batch = tfs.subspan(first, std::min<std::size_t>(kSweepLanes, tfs.size() - first));
        const SweepTables tables(batch, codes);
        const std::vector<double> sums = sweep(tables, job.part(first / kSweepLanes, batches));
        const auto lanes = static_cast<std::size_t>(lanesOf(tables.mode()));
        for (std::size_t lane = 0; lane < batch.size(); ++lane)
            all.push_back(featureSumsOf(sums, tables.features(), lane, lanes, weights));
    }
    return all;
}

SumsJacobian jacobianByBatches(const TransferFunction& tf, const SweepCodes& codes, const WeightFields* weights,
                               const JobControl& job, const SweepOnce& sweep) {
    SumsJacobian result;
    constexpr std::size_t kAtOnce = kJacobianLanes - 1;
    const std::size_t features = tf.features.size(),
                      sweeps = std::max<std::size_t>(1, (features + kAtOnce - 1) / kAtOnce);
    for (std::size_t first = 0; first < sweeps * kAtOnce; first += kAtOnce) {
        const SweepTables tables(tf, static_cast<int>(first), codes);
        const std::vector<double> sums = sweep(tables, job.part(first / kAtOnce, sweeps));
        if (first == 0) result.sums = featureSumsOf(sums, features, 0, kJacobianLanes, weights);
        for (std::size_t lane = 1; lane < kJacobianLanes && first + lane <= features; ++lane)
            result.byOpacity.push_back(featureSumsOf(sums, features, lane, kJacobianLanes, weights));
    }
    return result;
}

} // namespace pellucid
