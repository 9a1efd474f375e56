#include "volume/samples/cubic_zoom.h"

#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace pellucid {

namespace {

/// The four coarse places that a fine one is made of, along one axis.
struct Tap {
    std::array<int, 4> at{};
    std::array<float, 4> weight{};
};

std::vector<Tap> tapsOf(int coarse, int fine, bool periodic) {
    std::vector<Tap> taps(static_cast<std::size_t>(fine));
    for (int i = 0; i < fine; ++i) {
        const double p = (i + 0.5) * coarse / fine - 0.5;
        const int base = static_cast<int>(std::floor(p));
        const double t = p - base, t2 = t * t, t3 = t2 * t;
        const std::array<double, 4> w{-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t,
                                      0.5 * t3 - 0.5 * t2};
        Tap& tap = taps[static_cast<std::size_t>(i)];
        for (int n = 0; n < 4; ++n) {
            const int place = base - 1 + n;
            tap.at[static_cast<std::size_t>(n)] =
                periodic ? (place % coarse + coarse) % coarse : std::clamp(place, 0, coarse - 1);
            tap.weight[static_cast<std::size_t>(n)] = static_cast<float>(w[static_cast<std::size_t>(n)]);
        }
    }
    return taps;
}

} // namespace

Grid<float> cubicZoom(const Grid<float>& coarse, const Int3& dims, bool periodic, const JobControl& job) {
    const Int3 n = coarse.dims();
    const auto tx = tapsOf(n.x, dims.x, periodic), ty = tapsOf(n.y, dims.y, periodic),
               tz = tapsOf(n.z, dims.z, periodic);
    // Along x and y first, coarse slice by coarse slice.
    Grid<float> flat(Int3(dims.x, dims.y, n.z));
    parallelFor(static_cast<std::size_t>(n.z), [&](std::size_t slice) {
        job.throwIfStopped();
        const int k = static_cast<int>(slice);
        std::vector<float> rows(static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(n.y));
        for (int j = 0; j < n.y; ++j) {
            const float* row = coarse.data() + coarse.index(0, j, k);
            for (int i = 0; i < dims.x; ++i) {
                const Tap& t = tx[static_cast<std::size_t>(i)];
                float sum = 0;
                for (std::size_t a = 0; a < 4; ++a) sum += t.weight[a] * row[t.at[a]];
                rows[static_cast<std::size_t>(j) * static_cast<std::size_t>(dims.x) + static_cast<std::size_t>(i)] =
                    sum;
            }
        }
        for (int j = 0; j < dims.y; ++j) {
            const Tap& t = ty[static_cast<std::size_t>(j)];
            float* out = flat.data() + flat.index(0, j, k);
            for (std::size_t a = 0; a < 4; ++a) {
                const float* row = rows.data() + static_cast<std::size_t>(t.at[a]) * static_cast<std::size_t>(dims.x);
                for (int i = 0; i < dims.x; ++i) out[i] = (a == 0 ? 0 : out[i]) + t.weight[a] * row[i];
            }
        }
    });
    Grid<float> fine(dims);
    const std::size_t plane = layerSize(dims);
    parallelFor(static_cast<std::size_t>(dims.z), [&](std::size_t k) {
        job.throwIfStopped();
        const Tap& t = tz[k];
        float* out = fine.data() + k * plane;
        for (std::size_t a = 0; a < 4; ++a) {
            const float* from = flat.data() + static_cast<std::size_t>(t.at[a]) * plane;
            for (std::size_t i = 0; i < plane; ++i) out[i] = (a == 0 ? 0 : out[i]) + t.weight[a] * from[i];
        }
    });
    return fine;
}

} // namespace pellucid
