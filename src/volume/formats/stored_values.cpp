#include "volume/formats/stored_values.h"

namespace pellucid {

Selection selectionOf(const FileLayout& layout, int component, int step) {
    Selection selection;
    std::uint64_t stride = 1;
    auto ofSteps = static_cast<std::uint64_t>(std::max(step, 0)); // what is left of it for slower axes
    std::size_t spatial = 0;
    for (const FileAxis& axis : layout.axes) {
        const auto size = static_cast<std::uint64_t>(axis.size);
        if (axis.components) {
            selection.components = size;
            const auto named = static_cast<std::size_t>(std::max(component, 0));
            const bool ordered = named < layout.componentOrder.size();
            selection.first += stride * (ordered ? static_cast<std::uint64_t>(layout.componentOrder[named]) : named);
            selection.stepsAreApart = selection.stepsAreApart && selection.steps == 1;
        } else if (spatial < 3 && !axis.time) {
            selection.stepsAreApart = selection.stepsAreApart && selection.steps == 1;
            selection.dims[static_cast<int>(spatial)] = static_cast<int>(axis.size);
            selection.stride[spatial++] = stride;
        } else {
            selection.steps *= size;
            selection.first += stride * (ofSteps % size);
            ofSteps /= size;
        }
        stride *= size;
    }
    for (; spatial < 3; ++spatial) // an axis of one voxel continues the one before it
        selection.stride[spatial] = spatial == 0
                                        ? 1
                                        : selection.stride[spatial - 1] *
                                              static_cast<std::uint64_t>(selection.dims[static_cast<int>(spatial) - 1]);
    return selection;
}

bool isGapless(const Selection& selection) {
    const auto nx = static_cast<std::uint64_t>(selection.dims.x), ny = static_cast<std::uint64_t>(selection.dims.y);
    return selection.stride[0] == 1 && selection.stride[1] == nx && selection.stride[2] == nx * ny;
}

std::uint64_t Selection::placeOf(const Int3& voxel) const {
    std::uint64_t place = first;
    for (int a = 0; a < 3; ++a) place += static_cast<std::uint64_t>(voxel[a]) * stride[static_cast<std::size_t>(a)];
    return place;
}

[[noreturn]] void failEarly(const std::string& path, std::uint64_t bytes) {
    throw FileError("the data cannot be read beyond " + std::to_string(bytes) + " decoded bytes", path,
                    "the file may be damaged, write or copy it again");
}

} // namespace pellucid
