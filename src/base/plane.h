// Numbers where a picture has pixels.
#pragma once

#include <cstddef>
#include <vector>

namespace pellucid {

/// One number per pixel, top row first.
template <class T>
struct BasicPlane {
    int width = 0, height = 0;
    std::vector<T> values;

    BasicPlane() = default;
    BasicPlane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    T* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
    const T* row(int y) const { return const_cast<BasicPlane*>(this)->row(y); }
};
using Plane = BasicPlane<float>;

} // namespace pellucid
