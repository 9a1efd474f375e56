// A picture on the device as a viewer with another colour vision sees it. Includes no GL header, so that the window can
// use it beside Qt's own.
#pragma once

#include <memory>

#include "tf/color_vision.h"

namespace pellucid::gl {

/// Every member function, the constructor and the destructor need the same OpenGL context, 4.3 core or later, to be
/// current. GL state afterwards: as VolumeRaycaster leaves it.
class VisionFilter {
public:
    /// Throws Error where the shader does not compile.
    VisionFilter();
    ~VisionFilter();

    /// Draws the texture's width × height texels (sRGB, opaque) over the framebuffer, both GL names, from its lower
    /// left corner on. Throws Error where the device fails.
    void draw(unsigned texture, int width, int height, const LightMatrix& vision, unsigned framebuffer);

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

} // namespace pellucid::gl
