#include "render/background.h"

namespace pellucid {

void paintBackground(Image& image, const RenderSettings& settings) {
    if (!settings.background) return;
    const Rgb bottom = *settings.background, top = settings.backgroundTop.value_or(bottom);
    for (int y = 0; y < image.height; ++y) {
        const double up = 1 - (y + 0.5) / image.height;
        const double behind[3] = {bottom.r + up * (top.r - bottom.r), bottom.g + up * (top.g - bottom.g),
                                  bottom.b + up * (top.b - bottom.b)};
        for (int x = 0; x < image.width; ++x) {
            float* pixel = image.pixel(x, y);
            const auto alpha = static_cast<double>(pixel[3]);
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<float>(alpha * static_cast<double>(pixel[c]) + (1 - alpha) * behind[c]);
            pixel[3] = 1;
        }
    }
}

} // namespace pellucid
