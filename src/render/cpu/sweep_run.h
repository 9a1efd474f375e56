// Runs the pieces of sweeps on threads, and makes of many transfer functions as many sweeps as they need.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/job.h"
#include "render/cpu/sweep.h"
#include "render/cpu/sweep_tables.h"
#include "saliency/vws.h"

namespace pellucid {

/// Which pieces of a sweep are done here, where several processes share one: every `parts`-th from `part` on.
struct PieceShare {
    std::size_t part = 0, parts = 1;
    /// Given the sums of the own pieces, `size` of each, fills in those of the others.
    std::function<void(std::vector<std::vector<double>>&, std::size_t size)> complete;
};

/// Adds the sums of all pieces to `sums`, in their order.
void addUp(const std::vector<std::vector<double>>& ofPieces, std::vector<double>& sums);

/// Keeps the memory that pieces are worked on in.
class SweepRunner {
public:
    explicit SweepRunner(SweepKernel kernel, PieceShare share = {}) : m_kernel(kernel), m_share(std::move(share)) {}

    /// Adds the sums of all pieces to `sums` in their order, whatever thread made them. Throws Cancelled.
    void run(const SweepInput& in, const std::vector<SweepPiece>& pieces, std::vector<double>& sums,
             const JobControl& job = {});
    /// Likewise a few at a time, `which` of them: the sums of each, `size`, go to its place in `ofPieces`.
    void runSome(const SweepInput& in, const std::vector<SweepPiece>& pieces, std::span<const std::size_t> which,
                 std::size_t size, std::vector<std::vector<double>>& ofPieces, const JobControl& job = {});

private:
    std::shared_ptr<SweepScratch> borrowScratch();
    void returnScratch(std::shared_ptr<SweepScratch> scratch);

    SweepKernel m_kernel;
    PieceShare m_share;
    std::mutex m_mutex;
    std::vector<std::shared_ptr<SweepScratch>> m_scratch;
};

/// One sweep: the kernel's sums, SweepTables::sumCount() of them.
using SweepOnce = std::function<std::vector<double>(const SweepTables& tables, const JobControl& job)>;

/// VisibilityEngine::sums() and jacobian() by as many sweeps as the transfer functions need.
std::vector<FeatureSums> sumsByBatches(std::span<const TransferFunction> tfs, const SweepCodes& codes,
                                       const WeightFields* weights, const JobControl& job, const SweepOnce& sweep);
SumsJacobian jacobianByBatches(const TransferFunction& tf, const SweepCodes& codes, const WeightFields* weights,
                               const JobControl& job, const SweepOnce& sweep);

} // namespace pellucid
