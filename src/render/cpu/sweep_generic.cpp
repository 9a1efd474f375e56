// The sweep for any processor, and what all instruction sets share.
#include <algorithm>
#include <cmath>
#include <memory>

#include "render/cpu/sweep_kernel.inl"

namespace pellucid {

void* SweepScratch::bytes(Slot slot, std::size_t count) {
    constexpr std::size_t kAlignment = 64;
    auto& v = m_memory[slot];
    if (v.size() < count + kAlignment) v.resize(count + kAlignment);
    void* p = v.data();
    std::size_t space = v.size();
    return std::align(kAlignment, count, p, space);
}

namespace {

/// The rows of rays of a piece: one more is computed twice. Small volumes get more pieces than that asks for, so that
/// no thread waits long for the last one.
constexpr int kFewestRows = 6, kMostRows = 12, kPiecesWanted = 32;
/// Slices nearer to the eye than this share their rays: there are few.
constexpr double kNearest = 8;

void addPieces(const SweepInput& in, int begin, int end, double slopeStep, std::vector<SweepPiece>& pieces) {
    double lo = 1e30, hi = -1e30;
    for (const int k : {begin, end - 1}) {
        const double away = k - in.eyeW, scale = in.perspective ? slopeStep * away : in.raySpacing;
        double first = 0, last = in.nv - 1;
        if (in.pyramid) {
            first = std::max(first, in.eyeV - away);
            last = std::min(last, in.eyeV + away);
            if (first > last) { // none on this slice: any may come in between
                first = in.eyeV - away;
                last = in.eyeV + away;
            }
        }
        const double base = in.perspective ? in.eyeV : in.slopeV * k;
        lo = std::min(lo, (first - base) / scale);
        hi = std::max(hi, (last - base) / scale);
    }
    const int firstRow = static_cast<int>(std::floor(lo)), lastRow = static_cast<int>(std::floor(hi)) + 1;
    const int rows = std::clamp((lastRow - firstRow) / kPiecesWanted, kFewestRows, kMostRows);
    for (int b = firstRow; b < lastRow; b += rows)
        pieces.push_back({begin, end, slopeStep, b, std::min(lastRow, b + rows), b == firstRow, b + rows >= lastRow});
}

} // namespace

std::vector<SweepPiece> sweepPieces(const SweepInput& in) {
    std::vector<SweepPiece> pieces;
    if (!in.perspective) {
        addPieces(in, 0, in.nw, 0, pieces);
        return pieces;
    }
    const int first = std::max(0, static_cast<int>(std::floor(in.eyeW)) + 1);
    for (int end = in.nw; end > first;) {
        const double away = end - 1 - in.eyeW;
        const int begin =
            away <= kNearest ? first : std::max(first, static_cast<int>(std::floor(in.eyeW + away / 2)) + 1);
        addPieces(in, begin, end, in.raySpacing / away, pieces);
        end = begin;
    }
    return pieces;
}

void sweepGeneric(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums) {
    sweepPiece(in, piece, scratch, sums);
}

std::span<const SweepKernel> sweepKernels() {
    static const std::vector<SweepKernel> kernels = [] {
        std::vector<SweepKernel> all{sweepGeneric};
#ifdef PELLUCID_HAVE_AVX2_SWEEP
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) all.insert(all.begin(), sweepAvx2);
#endif
        return all;
    }();
    return kernels;
}

} // namespace pellucid
