// The sweep itself (see sweep.h): the order of its steps. Included by one .cpp per instruction set. The steps
// themselves, in reading order:
//   sweep_vectors.inl   vectors of eight and the functions on them
//   sweep_rays.inl      rays go from slice to slice and gather optical depth
//   sweep_voxels.inl    voxels take their depth from the rays around them and from a line of their own
//   sweep_accounts.inl  depths become visibilities, and these become sums per feature
// docs/method.md, "The cpu engine", says what is computed and what is approximate about it; docs/decisions/0002 why.
#include "render/cpu/sweep_accounts.inl"

namespace pellucid {
namespace {

/// One piece of a sweep.
template <SweepMode kMode, CodeKind kCodes>
class Sweeper {
    static constexpr int kFlushEvery = 4; ///< slices

public:
    Sweeper(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums)
        : m_in(in), m_piece(piece), m_lines(in), m_rays(in, piece, m_lines, scratch), m_accounts(in, scratch, sums),
          m_voxels(in, m_lines, scratch, m_accounts) {}

    /// Takes rays from where they start, slice by slice, to one slice distance in front of each; there the voxels of
    /// the slice ask for what the rays have met.
    void run() {
        if (m_in.endDepths != nullptr) return carry();
        int at = start(); // the sample plane that the rays have come to
        for (int k = m_piece.begin; k < m_piece.end; ++k) {
            for (; at < goal(k); ++at) {
                const Advance advance = m_rays.advanceTo(at + 1);
                for (int b = m_piece.firstRow; b <= m_piece.lastRow; ++b) m_rays.advanceRow(advance, b);
            }
            // Rows of rays go on as soon as no voxel needs them any more where they are: they are at hand now.
            const bool goOn = k + 1 < m_piece.end && at < goal(k + 1);
            measureSlice({k, at, m_rays.plane(k), extentOf(m_in, k)}, goOn ? m_rays.advanceTo(at + 1) : Advance{});
            at += goOn;
            if (k % kFlushEvery == kFlushEvery - 1) m_accounts.flush();
        }
        m_accounts.flush();
    }

private:
    int goal(int k) const { return (k - 1) * m_in.stepsPerSlice; }
    /// Before the first sample plane on which rays count.
    int start() const {
        const int first = m_lines.start();
        if (!m_in.bounded) return first;
        const double before = m_in.reach.lo[2] * m_in.stepsPerSlice - (m_in.reach.fromInside ? 0 : 1);
        return before <= first ? first : floorInt(before);
    }

    /// Takes rays through a block, measures nothing, and keeps what they have met: where they enter the reach of
    /// another block, and at their end. The last slice of the piece needs no rays beyond the slice before.
    void carry() {
        const int last = goal(m_piece.end - 1);
        for (int at = start(); at < last && m_lines.sampleW(at) < m_in.reach.hi[2]; ++at) {
            const Advance go = m_rays.advanceTo(at + 1);
            m_rays.prepareHandovers(go);
            for (int b = m_piece.firstRow; b < m_piece.lastRow; ++b) {
                m_rays.advanceRow(go, b);
                m_rays.handOver(go, b);
            }
        }
        m_rays.writeDepths();
    }

    /// Measures the voxels of a slice, row by row, that lie between the piece's rows of rays, and takes each row of
    /// rays on, where `go` leads anywhere, once the voxels have passed it.
    void measureSlice(const Slice& slice, const Advance& go) {
        const int b0 = m_piece.firstRow, b1 = m_piece.lastRow;
        const LinePlane& p = slice.rays;
        const Extent& extent = slice.extent;
        int next = b0; // the first row of rays that has not gone on
        const auto goOn = [&](int end) {
            for (; go.to != Advance::kNowhere && next < end; ++next) m_rays.advanceRow(go, next);
        };
        const int firstRow = larger(extent.v0, m_piece.outermostLow ? extent.v0 : floorInt(p.v(b0)) - 1),
                  lastRow = smaller(extent.v1, m_piece.outermostHigh ? extent.v1 : ceilInt(p.v(b1)) + 1);
        for (int v = firstRow; v <= lastRow && extent.u0 <= extent.u1; ++v) {
            const double b = (v - p.baseV) / p.scale; // where among the rows of rays
            if ((b < b0 && !m_piece.outermostLow) || (b >= b1 && !m_piece.outermostHigh)) continue;
            const int row = clampTo(floorInt(b), b0, b1 - 1);
            goOn(row);
            m_voxels.measureRow(slice, v, m_rays.strip(row), static_cast<float>(b - row));
        }
        goOn(b1 + 1);
    }

    const SweepInput& m_in;
    const SweepPiece& m_piece;
    Lines<kCodes> m_lines;
    Rays<kMode, kCodes> m_rays;
    Accounts<kMode> m_accounts;
    Voxels<kMode, kCodes> m_voxels;
};

void sweepPiece(const SweepInput& in, const SweepPiece& piece, SweepScratch& scratch, double* sums) {
    const auto run = [&]<SweepMode kMode>() {
        if (in.narrowCodes)
            Sweeper<kMode, CodeKind::Narrow>(in, piece, scratch, sums).run();
        else if (in.someInvalid)
            Sweeper<kMode, CodeKind::WideSomeInvalid>(in, piece, scratch, sums).run();
        else
            Sweeper<kMode, CodeKind::Wide>(in, piece, scratch, sums).run();
    };
    switch (in.mode) {
    case SweepMode::Single:
        return run.template operator()<SweepMode::Single>();
    case SweepMode::Batch:
        return run.template operator()<SweepMode::Batch>();
    case SweepMode::Jacobian:
        return run.template operator()<SweepMode::Jacobian>();
    }
}

} // namespace
} // namespace pellucid
