#include "volume/intensity_grid.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "volume/memory_use.h"
#include "volume/voxel_loops.h"

namespace pellucid {

IntensityCoder::IntensityCoder(const Volume& volume) {
    const ValueRange r = volume.range();
    const bool integers = volume.sampleType() != SampleType::F32 && volume.sampleType() != SampleType::F64;
    const double span = r.hi - r.lo;
    const bool wholeEnds = r.lo == std::floor(r.lo) && r.hi == std::floor(r.hi);
    m_exact = integers && wholeEnds && span >= 1 && span <= 65535;
    if (m_exact) {
        m_codeStep = 65535 / static_cast<int>(span);
        m_maxCode = static_cast<int>(span) * m_codeStep;
    }
}

namespace {

/// Hands `codes` over to `owner`; returns where they begin.
template <class Codes>
auto* held(Codes codes, std::shared_ptr<const void>& owner) {
    auto all = std::make_shared<const Codes>(std::move(codes));
    owner = all;
    return all->data();
}

} // namespace

CodeGrid::CodeGrid(const Int3& dims, ZeroedVector<std::uint16_t> wide) : m_dims(dims) {
    PELLUCID_CHECK(wide.size() == size() + kPadding);
    m_wide = held(std::move(wide), m_owner);
}

CodeGrid::CodeGrid(const Int3& dims, ZeroedVector<std::uint8_t> narrow) : m_dims(dims) {
    PELLUCID_CHECK(narrow.size() == size() + kPadding);
    m_narrow = held(std::move(narrow), m_owner);
}

CodeGrid::CodeGrid(const Int3& dims, SampleArray<std::uint8_t> narrow) : m_dims(dims) {
    static_assert(kPadding <= SampleArray<std::uint8_t>::kPadding);
    PELLUCID_CHECK(narrow.size() == size() && narrow.isPadded());
    m_narrow = held(std::move(narrow), m_owner);
}

namespace {

/// 8-bit samples of a window from 0 up to their largest value or beyond it are their own codes.
const SampleArray<std::uint8_t>* asCodes(const Volume& volume) {
    const auto* samples = std::get_if<SampleArray<std::uint8_t>>(&volume.samples());
    const bool asTheyAre = volume.range().lo == 0 && volume.dataRange().hi <= volume.range().hi;
    return samples != nullptr && samples->isPadded() && asTheyAre ? samples : nullptr;
}

constexpr int kInvalid = -1;

/// Code of a value, divided by `divisor`; kInvalid of an invalid one.
int codeOf(const Volume& volume, const IntensityCoder& coder, int divisor, double value) {
    const double s = volume.intensityOfValue(value);
    return std::isnan(s) ? kInvalid : coder.code(s) / divisor;
}

/// Hands the code of every voxel to write(i, code), on any thread.
template <class Write>
void forEachCode(const Volume& volume, const IntensityCoder& coder, int divisor, const Write& write) {
    withSamples(volume, [&](const auto& samples) {
        using T = typename std::decay_t<decltype(samples)>::value_type;
        if constexpr (std::is_integral_v<T> && sizeof(T) <= 2) {
            // So few values are possible that looking a code up is quicker than making it anew.
            constexpr int kLowest = std::numeric_limits<T>::lowest(), kHighest = std::numeric_limits<T>::max();
            if (samples.size() > static_cast<std::size_t>(kHighest - kLowest)) {
                std::vector<std::int32_t> codes;
                for (int v = kLowest; v <= kHighest; ++v) codes.push_back(codeOf(volume, coder, divisor, v));
                return forEachVoxel(volume, {}, [&](const auto& values, std::size_t i) {
                    write(i, codes[static_cast<std::size_t>(static_cast<int>(values[i]) - kLowest)]);
                });
            }
        }
        forEachVoxel(volume, {}, [&](const auto& values, std::size_t i) {
            write(i, codeOf(volume, coder, divisor, static_cast<double>(values[i])));
        });
    });
}

} // namespace

IntensityGrid makeIntensityGrid(const Volume& volume, CodeWidth width) {
    const IntensityCoder coder(volume);
    IntensityGrid grid;
    grid.maxCode = coder.maxCode();
    grid.codeStep = coder.codeStep();
    const bool wanted =
        width == CodeWidth::Narrow || (width == CodeWidth::BySize && isLean(volume.dims(), volume.sampleType()));
    if (wanted && coder.exact() && grid.maxCode / grid.codeStep <= 255 && volume.invalidCount() == 0) {
        grid.maxCode /= grid.codeStep;
        if (const auto* samples = asCodes(volume)) {
            grid.codes = CodeGrid(volume.dims(), *samples);
        } else {
            ZeroedVector<std::uint8_t> codes(volume.size() + CodeGrid::kPadding);
            forEachCode(volume, coder, grid.codeStep,
                        [&](std::size_t i, int code) { codes[i] = static_cast<std::uint8_t>(code); });
            grid.codes = CodeGrid(volume.dims(), std::move(codes));
        }
        grid.codeStep = 1;
        return grid;
    }
    ZeroedVector<std::uint16_t> codes(volume.size() + CodeGrid::kPadding);
    if (volume.invalidCount() > 0) grid.valid.assign(volume.size(), 1);
    forEachCode(volume, coder, 1, [&](std::size_t i, int code) {
        if (code == kInvalid)
            grid.valid[i] = 0;
        else
            codes[i] = static_cast<std::uint16_t>(code);
    });
    grid.codes = CodeGrid(volume.dims(), std::move(codes));
    return grid;
}

bool samplesAreNarrowCodes(const Volume& volume) { return asCodes(volume) != nullptr && volume.invalidCount() == 0; }

std::shared_ptr<const IntensityGrid> sharedIntensityGrid(const Volume& volume) {
    SharedCodes& shared = volume.sharedCodes();
    const std::lock_guard lock(shared.mutex); // who comes second waits for the first, and takes what that made
    std::shared_ptr<const IntensityGrid> grid = shared.grid.lock();
    if (!grid) shared.grid = grid = std::make_shared<const IntensityGrid>(makeIntensityGrid(volume));
    return grid;
}

} // namespace pellucid
