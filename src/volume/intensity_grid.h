// Intensities as 16-bit codes: what the fast engines and the GPU read instead of the samples.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/volume.h"

namespace pellucid {

/// How intensities of one volume become codes: s = code / maxCode.
class IntensityCoder {
public:
    explicit IntensityCoder(const Volume& volume);

    int maxCode() const noexcept { return m_maxCode; } ///< in [1, 65535]
    /// True for integer data whose window spans at most 65 535 values: then code / maxCode is s itself, because codes
    /// are a whole multiple of value − lo. Otherwise it is s rounded to 1/64000 = 2⁻⁹·5⁻³, so that the borders of bins
    /// and decimals of three digits are codes: voxels that have such an intensity are on the right side of it.
    bool exact() const noexcept { return m_exact; }
    /// Codes in use are multiples of this: the codes from one value to the next where exact, else 1.
    int codeStep() const noexcept { return m_codeStep; }
    /// Code of an intensity in [0,1].
    std::uint16_t code(double s) const { return static_cast<std::uint16_t>(s * m_maxCode + 0.5); }
    double intensity(int code) const { return static_cast<double>(code) / m_maxCode; }

private:
    int m_maxCode = 64000;
    int m_codeStep = 1;
    bool m_exact = false;
};

struct IntensityGrid {
    Grid<std::uint16_t> codes;       ///< shape of the volume; 0 where invalid
    int maxCode = 64000;             ///< intensity is code / maxCode
    int codeStep = 1;                ///< codes are multiples of this
    std::vector<std::uint8_t> valid; ///< one byte per voxel, 1 = valid; empty where every voxel is valid
};

IntensityGrid makeIntensityGrid(const Volume& volume);

/// The same, made once for a volume in its window and shared by all who hold it at a time: picture and measure. Made on
/// the calling thread; gone with the last holder. Any thread may call.
std::shared_ptr<const IntensityGrid> sharedIntensityGrid(const Volume& volume);

} // namespace pellucid
