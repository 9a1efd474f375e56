// The loops of ball_sums.h for vectors of PELLUCID_VECTOR_BYTES. Included by one .cpp per instruction set; everything
// here is in an unnamed namespace and uses no templates of the standard library, so that no code compiled for a newer
// processor leaks into the rest.
#include <cstring>

#include "saliency/ball_sums.h"

namespace pellucid {
namespace {

typedef float Vector __attribute__((vector_size(PELLUCID_VECTOR_BYTES)));
typedef int Integers __attribute__((vector_size(PELLUCID_VECTOR_BYTES)));
typedef unsigned short Packed __attribute__((vector_size(PELLUCID_VECTOR_BYTES / 2)));
constexpr int kLanes = PELLUCID_VECTOR_BYTES / 4;

inline Vector load(const float* p) {
    Vector v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
inline void store(float* p, Vector v) { std::memcpy(p, &v, sizeof v); }

/// The widened range begins and ends on whole vectors.
inline int wholeVectors(int floats) { return (floats + kLanes - 1) / kLanes * kLanes; }

/// [at, at + N vectors): N independent sums in registers.
template <int N>
inline void sumAlongZ(const BallSumsPlan& plan, const float* const* rows, int at, float* out) {
    Vector centre[N], surround[N];
    for (int i = 0; i < N; ++i) centre[i] = surround[i] = load(rows[0] + at + i * kLanes);
    for (int h = 0; h <= plan.zReach[1]; ++h) {
        const ZStep& step = plan.zSteps[h];
        if (h > 0) {
            const float *before = rows[-h] + at, *after = rows[h] + at;
            const bool both = h <= plan.zReach[0];
            for (int i = 0; i < N; ++i) {
                const Vector pair = load(before + i * kLanes) + load(after + i * kLanes);
                if (both) centre[i] += pair * step.weight[0];
                surround[i] += pair * step.weight[1];
            }
        }
        if (step.sum[0] >= 0)
            for (int i = 0; i < N; ++i) store(out + step.sum[0] * plan.stride + at + i * kLanes, centre[i]);
        if (step.sum[1] >= 0)
            for (int i = 0; i < N; ++i) store(out + step.sum[1] * plan.stride + at + i * kLanes, surround[i]);
    }
}

void sumRangeAlongZ(const BallSumsPlan& plan, const float* const* rows, int from, int to, float* out) {
    const int halo = wholeVectors(2 * plan.xReach);
    int at = from - halo;
    const int end = to + halo;
    for (; at + 4 * kLanes <= end; at += 4 * kLanes) sumAlongZ<4>(plan, rows, at, out);
    for (; at < end; at += kLanes) sumAlongZ<1>(plan, rows, at, out);
}

template <int N>
inline void sumProfiles(const BallSumsPlan& plan, const float* const* zSums, int at, float* out) {
    for (int p = 0; p < plan.profileCount; ++p) {
        const YProfile& profile = plan.profiles[p];
        Vector sum[N];
        const float* middle = zSums[0] + profile.offset + at;
        for (int i = 0; i < N; ++i) sum[i] = load(middle + i * kLanes);
        for (int t = profile.firstTap; t < profile.endTap; ++t) {
            const YTap& tap = plan.yTaps[t];
            const float *before = zSums[-tap.dy] + tap.offset + at, *after = zSums[tap.dy] + tap.offset + at;
            for (int i = 0; i < N; ++i) sum[i] += (load(before + i * kLanes) + load(after + i * kLanes)) * tap.weight;
        }
        for (int i = 0; i < N; ++i) store(out + p * plan.stride + at + i * kLanes, sum[i]);
    }
}

/// |centre·scale − surround·scale|, rounded to 16 bits; brightness and saturation of a voxel are neighbours already.
template <int N>
inline void pack(const Vector (&centre)[N], const Vector (&surround)[N], const RowScales& scales, int at,
                 std::uint32_t* out) {
    for (int i = 0; i < N; ++i) {
        const int x = at + i * kLanes;
        const Vector l = centre[i] * load(scales.centre + x) - surround[i] * load(scales.surround + x);
        const Vector rounded = (l < 0.0f ? -l : l) + 0.5f;
        const Vector bounded = rounded < 65535.0f ? rounded : Vector{} + 65535.0f;
        const Packed values = __builtin_convertvector(__builtin_convertvector(bounded, Integers), Packed);
        // In memory the first of two neighbours is the low half where bytes are in little-endian order.
        static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
        std::memcpy(reinterpret_cast<char*>(out) + 2 * x, &values, sizeof values);
    }
}

template <int N>
inline void sumAlongX(const BallSumsPlan& plan, int ball, const float* profiles, Vector (&sum)[N]) {
    const float* middle = profiles + plan.xMiddle[ball];
    for (int i = 0; i < N; ++i) sum[i] = load(middle + i * kLanes);
    const XTap *tap = plan.xTaps[ball], *end = tap + plan.xTapCount[ball];
    for (; tap < end; ++tap) {
        const float *before = profiles + tap->before, *after = profiles + tap->after;
        for (int i = 0; i < N; ++i) sum[i] += (load(before + i * kLanes) + load(after + i * kLanes)) * tap->weight;
    }
}

void packRow(const BallSumsPlan& plan, const float* const* zSums, const RowScales& scales, int from, int to,
             float* scratch, std::uint32_t* out) {
    const int halo = wholeVectors(2 * plan.xReach);
    int at = from - halo;
    const int end = to + halo;
    for (; at + 4 * kLanes <= end; at += 4 * kLanes) sumProfiles<4>(plan, zSums, at, scratch);
    for (; at < end; at += kLanes) sumProfiles<1>(plan, zSums, at, scratch);
    constexpr int kVectors = BallSumsKernel::kRangeFloats / kLanes < 4 ? BallSumsKernel::kRangeFloats / kLanes : 4;
    for (at = from; at < to; at += kVectors * kLanes) {
        Vector centre[kVectors], surround[kVectors];
        sumAlongX(plan, 0, scratch + at, centre);
        sumAlongX(plan, 1, scratch + at, surround);
        pack(centre, surround, scales, at, out);
    }
}

void packRowDirect(const DirectRun* const* runs, const int* runCounts, const RowScales& scales, int from, int to,
                   std::uint32_t* out) {
    constexpr int kVectors = BallSumsKernel::kRangeFloats / kLanes;
    for (int at = from; at < to; at += kVectors * kLanes) {
        Vector sum[2][kVectors] = {};
        for (int ball = 0; ball < 2; ++ball)
            for (int r = 0; r < runCounts[ball]; ++r) {
                const DirectRun& run = runs[ball][r];
                const float* source = run.row + at - 2 * run.halfWidth;
                for (int dx = 0; dx <= 2 * run.halfWidth; ++dx, source += 2)
                    for (int i = 0; i < kVectors; ++i) sum[ball][i] += load(source + i * kLanes) * run.weights[dx];
            }
        pack<kVectors>(sum[0], sum[1], scales, at, out);
    }
}

} // namespace
} // namespace pellucid
