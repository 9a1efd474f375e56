// makeGlRenderer: the ray caster on a context of its own, tile by tile into memory.
#include <algorithm>

#include "render/gl/gl_engines.h"
#include "render/gl/gl_resources.h"
#include "render/gl/headless_context.h"
#include "render/gl/volume_raycaster.h"

namespace pellucid {

namespace {

constexpr int kTile = 2048; ///< pixels; bounds the memory on the device whatever the image's size

class GlRenderer final : public ImageRenderer {
public:
    explicit GlRenderer(const std::shared_ptr<const Volume>& volume) {
        m_raycaster.emplace([&] {
            auto raycaster = std::make_unique<gl::VolumeRaycaster>();
            raycaster->setVolume(volume);
            return raycaster;
        });
    }

    std::string name() const override { return "gl"; }

    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        settings.validate();
        Image image(settings.width, settings.height);
        m_raycaster.run([&](gl::VolumeRaycaster& raycaster) {
            raycaster.setTransferFunction(tf);
            const int across = (settings.width + kTile - 1) / kTile, down = (settings.height + kTile - 1) / kTile;
            for (int i = 0; i < across * down; ++i) {
                const int x = i % across * kTile, y = i / across * kTile;
                drawTile(raycaster, camera, settings, x, y, image,
                         job.part(static_cast<std::size_t>(i), static_cast<std::size_t>(across * down)));
            }
        });
        return image;
    }

private:
    static void drawTile(gl::VolumeRaycaster& raycaster, const Camera& camera, const RenderSettings& settings, int x,
                         int y, Image& image, const JobControl& job) {
        const int width = std::min(kTile, settings.width - x), height = std::min(kTile, settings.height - y);
        const auto target = gl::makeColorTarget({width, height}, GL_RGBA32F, GL_NEAREST, "the picture");
        raycaster.draw(camera, settings, {target.framebuffer.id(), 0, 0, x, y, width, height, 1.0}, job);

        std::vector<float> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, pixels.data());
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        gl::throwOnGlError("reading the picture");
        const std::size_t row = static_cast<std::size_t>(width) * 4;
        for (int line = 0; line < height; ++line) { // GL's rows go up, the image's down
            const float* from = &pixels[static_cast<std::size_t>(height - 1 - line) * row];
            std::copy_n(from, row, image.pixel(x, y + line));
        }
        if (settings.background) return;
        for (int line = 0; line < height; ++line)
            for (int column = 0; column < width; ++column) {
                float* p = image.pixel(x + column, y + line);
                if (p[3] > 0)
                    for (int c = 0; c < 3; ++c) p[c] /= p[3];
            }
    }

    gl::InContext<gl::VolumeRaycaster> m_raycaster;
};

} // namespace

// NOLINTNEXTLINE(performance-unnecessary-value-param): as the other makers of renderers take it
std::unique_ptr<ImageRenderer> makeGlRenderer(std::shared_ptr<const Volume> volume) {
    return std::make_unique<GlRenderer>(volume);
}

} // namespace pellucid
