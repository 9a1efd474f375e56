// Draws the volume, a ray per pixel, into any framebuffer of the current OpenGL context: the one renderer of the window
// and of the command line. Includes no GL header, so that the window can use it beside Qt's own.
#pragma once

#include <memory>

#include "base/job.h"
#include "render/render_settings.h"
#include "tf/transfer_function.h"
#include "volume/volume.h"

namespace pellucid::gl {

/// Where a picture goes.
struct DrawTarget {
    unsigned framebuffer = 0; ///< GL name of the framebuffer drawn into (QOpenGLWidget::defaultFramebufferObject())
    int x = 0, y = 0;         ///< where the lower left corner of the picture, or of the tile, goes, pixels
    /// The part of the RenderSettings' width × height image that is drawn, pixels from its top left corner; width and
    /// height 0: all of it. Lets a large image be drawn in tiles.
    int tileX = 0, tileY = 0, tileWidth = 0, tileHeight = 0;
    /// Rays per pixel along each axis, (0, 1]: below 1 the picture is drawn smaller and enlarged, for a quick answer
    /// while the mouse moves.
    double resolutionScale = 1.0;
};

/// What every pixel's ray meets (docs/method.md, "The picture"), followed by a fragment shader from front to back.
///
/// Every member function, the constructor and the destructor need the same OpenGL context, 4.3 core or later, to be
/// current. GL state afterwards: no program, vertex array or texture bound; blending, depth, stencil and scissor test
/// and face culling off; depth function and all write masks as GL has them at first; the target framebuffer bound and
/// the viewport over the picture.
class VolumeRaycaster {
public:
    /// Compiles the shaders. Throws Error where the context is older than 4.3 or a shader does not compile.
    VolumeRaycaster();
    ~VolumeRaycaster();

    /// Uploads the intensities: in bricks where the volume is longer than the device's textures, and brick by brick at
    /// every drawing, which takes its time, where the device has not the memory for all. Throws Error (not even memory
    /// for one brick); the former volume stays then. `longestTexture` (≥ 16): as if the device took no longer ones.
    void setVolume(std::shared_ptr<const Volume> volume, int longestTexture = 1 << 30);
    /// Cheap: a table of some thousand entries; nothing happens where `tf` equals the present one.
    void setTransferFunction(const TransferFunction& tf);

    /// Draws settings.width × settings.height pixels (or the tile) over whatever the target holds. Needs a volume and a
    /// transfer function. With a background the result is opaque; without, colours are premultiplied by alpha.
    /// settings.stepInD0 is the largest distance of samples along a ray: larger is faster and coarser. Colours of
    /// voxels go up when they are other ones than before; the ground is drawn by the CPU, once for all tiles of a
    /// picture. Throws Error (invalid camera or settings, the device fails), Cancelled.
    void draw(const Camera& camera, const RenderSettings& settings, const DrawTarget& target,
              const JobControl& job = {});

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

} // namespace pellucid::gl
