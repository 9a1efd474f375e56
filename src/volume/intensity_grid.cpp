#include "volume/intensity_grid.h"

#include <cmath>
#include <type_traits>

#include "base/parallel.h"

namespace pellucid {

IntensityCoder::IntensityCoder(const Volume& volume) {
    const ValueRange r = volume.range();
    const bool integers =
        std::visit([](const auto& v) { return std::is_integral_v<typename std::decay_t<decltype(v)>::value_type>; },
                   volume.samples());
    const double span = r.hi - r.lo;
    const bool wholeEnds = r.lo == std::floor(r.lo) && r.hi == std::floor(r.hi);
    m_exact = integers && wholeEnds && span >= 1 && span <= 65535;
    if (m_exact) {
        m_codeStep = 65535 / static_cast<int>(span);
        m_maxCode = static_cast<int>(span) * m_codeStep;
    }
}

IntensityGrid makeIntensityGrid(const Volume& volume) {
    const IntensityCoder coder(volume);
    IntensityGrid grid;
    grid.codes = Grid<std::uint16_t>(volume.dims());
    grid.maxCode = coder.maxCode();
    grid.codeStep = coder.codeStep();
    if (volume.invalidCount() > 0) grid.valid.assign(volume.size(), 1);
    std::visit(
        [&](const auto& values) {
            const std::size_t slices = static_cast<std::size_t>(volume.dims().z);
            const std::size_t plane = volume.size() / slices;
            parallelFor(slices, [&](std::size_t k) {
                for (std::size_t i = k * plane; i < (k + 1) * plane; ++i) {
                    const double s = volume.intensityOfValue(static_cast<double>(values[i]));
                    if (std::isnan(s))
                        grid.valid[i] = 0;
                    else
                        grid.codes[i] = coder.code(s);
                }
            });
        },
        volume.samples());
    return grid;
}

std::shared_ptr<const IntensityGrid> sharedIntensityGrid(const Volume& volume) {
    SharedCodes& shared = volume.sharedCodes();
    const std::lock_guard lock(shared.mutex); // who comes second waits for the first, and takes what that made
    std::shared_ptr<const IntensityGrid> grid = shared.grid.lock();
    if (!grid) shared.grid = grid = std::make_shared<const IntensityGrid>(makeIntensityGrid(volume));
    return grid;
}

} // namespace pellucid
