#include "volume/spacing.h"

#include <cmath>

#include "base/round_numbers.h"

namespace pellucid {

std::string geometryProblem(const Vec3& spacing, const Vec3& origin) {
    for (int a = 0; a < 3; ++a) {
        const std::string is = "the spacing of axis " + std::to_string(a) + " is " + plainText(spacing[a]);
        if (!(spacing[a] > 0) || !std::isfinite(spacing[a])) return is + ", it must be positive and finite";
        if (spacing[a] < kLeastSpacing)
            return is + ", too small to compute with: it must be at least " + plainText(kLeastSpacing);
        if (spacing[a] > kMostSpacing)
            return is + ", too large to compute with: it must be at most " + plainText(kMostSpacing);
        if (!std::isfinite(origin[a])) return "the place of the first voxel is not finite";
    }
    return {};
}

} // namespace pellucid
