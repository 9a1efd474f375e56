#include "saliency/published_saliency.h"

#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "tf/eight_bit.h"
#include "tf/lch.h"
#include "volume/intensity_grid.h"

namespace pellucid {

namespace {

constexpr std::array<int, 2> kRadii{2, 4}; ///< of centre and surround, voxels
constexpr int kReach = 4;
constexpr int kSlices = 16, kRows = 32; ///< of the pieces that threads work on

/// I_k(t) = Σ_m (t/2)^(2m+k) / (m!·(m+k)!).
double modifiedBessel(int k, double t) {
    double term = 1;
    for (int n = 1; n <= k; ++n) term *= t / 2 / n;
    double sum = term;
    for (int m = 1; term > 1e-17 * sum; ++m) sum += term *= t * t / 4 / m / (m + k);
    return sum;
}

using Pair = std::array<float, 2>; ///< brightness, saturation

/// By code.
std::vector<Pair> appearances(const IntensityGrid& grid, const TransferFunction& tf) {
    const TfSampler sampler(tf);
    std::vector<Pair> table(static_cast<std::size_t>(grid.maxCode) + 1, Pair{0, 0});
    for (int code = 0; code <= grid.maxCode; code += grid.codeStep) {
        const Appearance o = publishedAppearanceOf(sampler.color(static_cast<double>(code) / grid.maxCode));
        table[static_cast<std::size_t>(code)] = {static_cast<float>(o.brightness), static_cast<float>(o.saturation)};
    }
    return table;
}

/// One block of rows and slices of the volume, smoothed by both kernels.
class Piece {
public:
    Piece(const IntensityGrid& grid, const std::vector<Pair>& table, int slice, int row)
        : m_grid(grid), m_table(table), m_dims(grid.codes.dims()), m_z(slice), m_y(row),
          m_slices(std::min(kSlices, m_dims.z - slice)), m_rows(std::min(kRows, m_dims.y - row)),
          m_width(static_cast<std::size_t>(m_dims.x)) {
        for (std::size_t r = 0; r < kRadii.size(); ++r)
            for (const double w : discreteGaussian(kRadii[r])) m_kernels[r].push_back(static_cast<float>(w));
    }

    void writeTo(WeightFields& fields) {
        const auto planes = static_cast<std::size_t>(m_slices + 2 * kReach);
        for (auto& smooth : m_smooth) smooth.assign(planes * static_cast<std::size_t>(m_rows) * m_width, Pair{0, 0});
        for (int z = -kReach; z < m_slices + kReach; ++z) smoothSlice(z);
        std::vector<Pair> centre(m_width), surround(m_width);
        for (int z = 0; z < m_slices; ++z)
            for (int y = 0; y < m_rows; ++y) {
                alongZ(0, z, y, centre);
                alongZ(1, z, y, surround);
                const std::size_t first = m_grid.codes.index(0, m_y + y, m_z + z);
                for (std::size_t x = 0; x < m_width; ++x)
                    fields.set(first + x, std::abs(centre[x][0] - surround[x][0]),
                               std::abs(centre[x][1] - surround[x][1]));
            }
    }

private:
    /// Pieces may overlap beyond the volume: the edge is repeated.
    static int within(int i, int count) { return std::clamp(i, 0, count - 1); }

    Pair* smoothRow(std::size_t kernel, int z, int y) {
        const std::size_t row =
            static_cast<std::size_t>(z + kReach) * static_cast<std::size_t>(m_rows) + static_cast<std::size_t>(y);
        return m_smooth[kernel].data() + row * m_width;
    }

    /// Along x into rows of this slice, then along y.
    void smoothSlice(int z) {
        const int slice = within(m_z + z, m_dims.z);
        const auto rows = static_cast<std::size_t>(m_rows + 2 * kReach);
        std::array<std::vector<Pair>, 2> alongX;
        for (auto& smooth : alongX) smooth.resize(rows * m_width);
        std::vector<Pair> padded(m_width + 2 * kReach);
        for (std::size_t row = 0; row < rows; ++row) {
            const int y = within(m_y + static_cast<int>(row) - kReach, m_dims.y);
            readRow(m_grid.codes.index(0, y, slice), padded);
            for (std::size_t kernel = 0; kernel < 2; ++kernel) {
                Pair* out = alongX[kernel].data() + row * m_width;
                for (std::size_t x = 0; x < m_width; ++x) out[x] = weighted(kernel, padded.data() + x + kReach, 1);
            }
        }
        for (std::size_t kernel = 0; kernel < 2; ++kernel)
            for (int y = 0; y < m_rows; ++y) {
                const Pair* from = alongX[kernel].data() + static_cast<std::size_t>(y + kReach) * m_width;
                Pair* out = smoothRow(kernel, z, y);
                for (std::size_t x = 0; x < m_width; ++x)
                    out[x] = weighted(kernel, from + x, static_cast<std::ptrdiff_t>(m_width));
            }
    }

    void alongZ(std::size_t kernel, int z, int y, std::vector<Pair>& out) {
        const Pair* from = smoothRow(kernel, z, y);
        const auto stride = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(m_rows) * m_width);
        for (std::size_t x = 0; x < m_width; ++x) out[x] = weighted(kernel, from + x, stride);
    }

    void readRow(std::size_t first, std::vector<Pair>& padded) const {
        m_grid.codes.visit([&](const auto* codes) {
            for (std::size_t x = 0; x < m_width; ++x) {
                const bool valid = m_grid.valid.empty() || m_grid.valid[first + x] != 0;
                padded[x + kReach] = valid ? m_table[codes[first + x]] : Pair{0, 0};
            }
        });
        std::fill_n(padded.begin(), kReach, padded[kReach]);
        std::fill_n(padded.end() - kReach, kReach, padded[m_width + kReach - 1]);
    }

    Pair weighted(std::size_t kernel, const Pair* at, std::ptrdiff_t stride) const {
        const std::vector<float>& w = m_kernels[kernel];
        Pair sum{w[0] * at[0][0], w[0] * at[0][1]};
        for (std::size_t k = 1; k < w.size(); ++k) {
            const std::ptrdiff_t off = stride * static_cast<std::ptrdiff_t>(k);
            for (std::size_t a = 0; a < 2; ++a) sum[a] += w[k] * (at[off][a] + at[-off][a]);
        }
        return sum;
    }

    const IntensityGrid& m_grid;
    const std::vector<Pair>& m_table;
    Int3 m_dims;
    int m_z, m_y, m_slices, m_rows;
    std::size_t m_width;
    std::array<std::vector<float>, 2> m_kernels;
    std::array<std::vector<Pair>, 2> m_smooth; ///< rows of slices m_z − kReach …, smoothed along x and y
};

} // namespace

Appearance publishedAppearanceOf(const Rgb& srgb) {
    const double r = linearFromSrgb(roundedToEightBits(srgb.r)), g = linearFromSrgb(roundedToEightBits(srgb.g)),
                 b = linearFromSrgb(roundedToEightBits(srgb.b));
    // sRGB's primaries adapted to D50; each row is divided by its own sum, the white point's X, Y or Z.
    const double fx = labCurve((0.4360747 * r + 0.3850649 * g + 0.1430804 * b) / (0.4360747 + 0.3850649 + 0.1430804));
    const double fy = labCurve((0.2225045 * r + 0.7168786 * g + 0.0606169 * b) / (0.2225045 + 0.7168786 + 0.0606169));
    const double fz = labCurve((0.0139322 * r + 0.0971045 * g + 0.7141733 * b) / (0.0139322 + 0.0971045 + 0.7141733));
    return {(116 * fy - 16) / 100, std::hypot(500 * (fx - fy), 200 * (fy - fz)) / 100};
}

std::vector<double> discreteGaussian(int radius) {
    const double t = std::pow(radius * std::numbers::sqrt2 / 8, 2);
    std::vector<double> weights;
    double sum = 0;
    for (int k = 0; k <= radius; ++k) {
        weights.push_back(std::exp(-t) * modifiedBessel(k, t));
        sum += (k == 0 ? 1 : 2) * weights.back();
    }
    for (double& w : weights) w /= sum;
    return weights;
}

WeightFields publishedSaliencyFields(const Volume& volume, const TransferFunction& tf, const JobControl& job) {
    const std::shared_ptr<const IntensityGrid> grid = sharedIntensityGrid(volume);
    const std::vector<Pair> table = appearances(*grid, tf);
    const Int3 dims = volume.dims();
    WeightFields fields(dims, 1, 1.34); // no sRGB colour has O_b above 1 or O_s above 1.34
    const auto pieces = [](int count, int size) { return static_cast<std::size_t>((count + size - 1) / size); };
    const std::size_t across = pieces(dims.y, kRows), all = across * pieces(dims.z, kSlices);
    std::atomic<std::size_t> done = 0;
    parallelFor(all, [&](std::size_t n) {
        job.throwIfStopped();
        Piece(*grid, table, static_cast<int>(n / across) * kSlices, static_cast<int>(n % across) * kRows)
            .writeTo(fields);
        job.report(static_cast<double>(++done) / static_cast<double>(all));
    });
    return fields;
}

} // namespace pellucid
