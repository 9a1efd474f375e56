// Heights of opacities along the vertical axis of the transfer function.
#pragma once

#include <cmath>
#include <vector>

namespace pellucid::gui {

/// Fine: the height is ∛α. A ray meets hundreds of voxels, so that most of what opacity does happens below 0.05, which
/// has more than a third of the axis then.
class OpacityAxis {
public:
    bool isFine() const { return m_fine; }
    void setFine(bool fine) { m_fine = fine; }

    double height(double opacity) const { return m_fine ? std::cbrt(opacity) : opacity; } ///< [0,1]
    double opacity(double height) const {                                                 ///< [0,1], of any height
        // To pixels and back leaves rounding: an opacity of 0 is to stay 0, which means that there is nothing.
        constexpr double kRounding = 1e-9;
        if (height < kRounding) return 0;
        if (height > 1 - kRounding) return 1;
        return m_fine ? height * height * height : height;
    }
    /// Opacities that are written at the axis; the first ones before the others where there is no room for all.
    std::vector<double> labels() const {
        return m_fine ? std::vector<double>{0, 1, 0.05, 0.2, 0.01, 0.001, 0.5}
                      : std::vector<double>{0, 1, 0.5, 0.25, 0.75};
    }

private:
    bool m_fine = true;
};

} // namespace pellucid::gui
