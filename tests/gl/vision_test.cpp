// The picture on the device as other viewers see it: the shader does what seenColor() does.
#include "gl_test.h"

#include "render/gl/gl_resources.h"
#include "render/gl/vision_filter.h"

using namespace pellucid;
using namespace pellucid::gl;
using namespace pellucid::testing;

TEST_CASE("a picture on the device is seen as one in memory", "[gl][vision]") {
    if (!haveGl()) return;
    constexpr int kSize = 16;
    // 256 colours: red and green in steps of 17, blue the other way.
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            for (const int v : {17 * x, 17 * y, 255 - 17 * x, 255}) pixels.push_back(static_cast<std::uint8_t>(v));
    HeadlessContext context;
    for (const VisionKind vision : allOf<VisionKind>()) {
        CAPTURE(name(vision));
        const LightMatrix matrix = visionMatrix(vision);
        std::vector<std::uint8_t> seen(pixels.size());
        context.run([&] {
            const Texture2d picture = makeTexture2d({kSize, kSize}, GL_RGBA8, GL_NEAREST, "the picture");
            upload(picture, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data(), "uploading the picture");
            const ColorTarget target = makeColorTarget({kSize, kSize}, GL_RGBA8, GL_NEAREST, "the target");
            VisionFilter filter;
            filter.draw(picture.name.id(), kSize, kSize, matrix, target.framebuffer.id());
            glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
            glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, seen.data());
            throwOnGlError("reading the picture");
        });
        int farthest = 0;
        for (std::size_t i = 0; i < pixels.size(); i += 4) {
            const auto of = [](std::uint8_t v) { return v / 255.0; };
            const Rgb color = seenColor({of(pixels[i]), of(pixels[i + 1]), of(pixels[i + 2])}, matrix);
            for (const auto& [value, c] : {std::pair(color.r, 0), std::pair(color.g, 1), std::pair(color.b, 2)})
                farthest = std::max(farthest, std::abs(static_cast<int>(std::lround(255 * value)) -
                                                       seen[i + static_cast<std::size_t>(c)]));
            CHECK(seen[i + 3] == 255);
        }
        CHECK(farthest <= 1); // single precision, and rounding
    }
}
