// Intensities as codes of 16 bits or 8: what the fast engines and the GPU read instead of the samples.
#pragma once

#include <cstdint>
#include <vector>

#include "base/zeroed_memory.h"
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

/// The codes of a volume, x fastest: 16 bits each ("wide") or 8 ("narrow"). Immutable; copies share them.
class CodeGrid {
public:
    static constexpr std::size_t kPadding = 16; ///< codes that may be read behind the last one

    CodeGrid() = default;
    CodeGrid(const Int3& dims, ZeroedVector<std::uint16_t> wide); ///< kPadding more than voxels
    CodeGrid(const Int3& dims, ZeroedVector<std::uint8_t> narrow);
    CodeGrid(const Int3& dims, SampleArray<std::uint8_t> narrow); ///< padded samples, which are codes as they are

    const Int3& dims() const noexcept { return m_dims; }
    std::size_t size() const noexcept { return voxelCount(m_dims); }
    std::size_t index(int i, int j, int k) const { return voxelIndex(m_dims, i, j, k); }
    bool isNarrow() const noexcept { return m_narrow != nullptr; }
    const std::uint16_t* wide() const noexcept { return m_wide; }    ///< null where narrow
    const std::uint8_t* narrow() const noexcept { return m_narrow; } ///< null where wide
    std::uint16_t operator[](std::size_t i) const { return m_narrow ? m_narrow[i] : m_wide[i]; }
    /// Calls use(pointer) with the one that is not null.
    template <class Use>
    decltype(auto) visit(const Use& use) const {
        return m_narrow ? use(m_narrow) : use(m_wide);
    }

private:
    Int3 m_dims{0, 0, 0};
    std::shared_ptr<const void> m_owner;
    const std::uint16_t* m_wide = nullptr;
    const std::uint8_t* m_narrow = nullptr;
};

struct IntensityGrid {
    CodeGrid codes;                  ///< 0 where invalid
    int maxCode = 64000;             ///< intensity is code / maxCode
    int codeStep = 1;                ///< codes are multiples of this
    std::vector<std::uint8_t> valid; ///< one byte per voxel, 1 = valid; empty where every voxel is valid
};

/// Whether codes are narrow: where 8 bits hold all intensities exactly and every voxel is valid, it saves memory and
/// costs nothing but that textures of 8 bits are filtered more coarsely by some graphics devices.
enum class CodeWidth {
    BySize, ///< of volumes that isLean()
    Wide,   ///< never
    Narrow  ///< wherever it can be
};
/// Narrow codes are value − lo, in the window 0 … maxCode padded samples themselves: these take no more memory.
IntensityGrid makeIntensityGrid(const Volume& volume, CodeWidth width = CodeWidth::BySize);
bool samplesAreNarrowCodes(const Volume& volume);

/// The same, made once for a volume in its window and shared by all who hold it at a time: picture and measure. Made on
/// the calling thread; gone with the last holder. Any thread may call.
std::shared_ptr<const IntensityGrid> sharedIntensityGrid(const Volume& volume);

} // namespace pellucid
