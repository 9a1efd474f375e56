#include "session/coarser_input.h"

#include "base/check.h"
#include "volume/excerpt.h"

namespace pellucid {

MeasureInput coarserInput(const MeasureInput& input, int factor) {
    PELLUCID_CHECK(factor >= 1);
    if (factor == 1) return input;
    MeasureInput coarser = input;
    coarser.volume = std::make_shared<const Volume>(coarserCopy(*input.volume, factor));
    if (input.colors) coarser.colors = std::make_shared<const VoxelColors>(coarserColors(*input.colors, factor));
    return coarser;
}

} // namespace pellucid
