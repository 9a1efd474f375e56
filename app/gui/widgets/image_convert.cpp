#include "widgets/image_convert.h"

#include <algorithm>
#include <cmath>

namespace pellucid::gui {

QImage qImageFromImage(const Image& image) {
    QImage result(image.width, image.height, QImage::Format_RGBA8888);
    for (int y = 0; y < image.height; ++y) {
        uchar* line = result.scanLine(y);
        const float* pixel = image.pixel(0, y);
        for (int i = 0; i < 4 * image.width; ++i) {
            line[i] = static_cast<uchar>(std::lround(std::clamp(pixel[i], 0.0f, 1.0f) * 255.0f));
        }
    }
    return result;
}

} // namespace pellucid::gui
