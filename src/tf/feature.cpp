#include "tf/feature.h"

namespace pellucid {

int featureAt(std::span<const Feature> features, double s) {
    for (std::size_t f = 0; f < features.size(); ++f)
        if (features[f].contains(s)) return static_cast<int>(f);
    return -1;
}

} // namespace pellucid
