#include "volume/coarser_colors.h"

#include <algorithm>
#include <array>

#include <glm/common.hpp>

#include "base/check.h"
#include "base/parallel.h"

namespace pellucid {

VoxelColors coarserColors(const VoxelColors& colors, int factor) {
    PELLUCID_CHECK(factor >= 1);
    const Int3 n = colors.dims;
    VoxelColors coarse{(n - 1) / glm::min(Int3(factor), n) + 1, {}};
    const Int3 d = coarse.dims, step = glm::min(Int3(factor), n);
    coarse.rgba.resize(voxelCount(d));
    parallelFor(static_cast<std::size_t>(d.z), [&](std::size_t slice) {
        std::size_t out = slice * static_cast<std::size_t>(d.x) * static_cast<std::size_t>(d.y);
        const int k0 = static_cast<int>(slice) * step.z;
        for (int j0 = 0; j0 < d.y * step.y; j0 += step.y)
            for (int i0 = 0; i0 < d.x * step.x; i0 += step.x) {
                std::array<std::uint32_t, 3> sum{};
                std::uint32_t count = 0;
                for (int k = k0; k < std::min(k0 + step.z, n.z); ++k)
                    for (int j = j0; j < std::min(j0 + step.y, n.y); ++j)
                        for (int i = i0; i < std::min(i0 + step.x, n.x); ++i) {
                            const std::uint32_t c =
                                colors.rgba[static_cast<std::size_t>(i) +
                                            static_cast<std::size_t>(n.x) *
                                                (static_cast<std::size_t>(j) +
                                                 static_cast<std::size_t>(n.y) * static_cast<std::size_t>(k))];
                            for (std::size_t a = 0; a < 3; ++a) sum[a] += c >> (8 * a) & 255u;
                            ++count;
                        }
                const auto mean = [&](std::size_t a) {
                    return static_cast<std::uint8_t>((sum[a] + count / 2) / count);
                };
                coarse.rgba[out++] = VoxelColors::pack(mean(0), mean(1), mean(2));
            }
    });
    return coarse;
}

} // namespace pellucid
