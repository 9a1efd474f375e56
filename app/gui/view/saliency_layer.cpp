#include "view/saliency_layer.h"

#include <algorithm>

#include <QPainter>

#include "controllers/picture_saliency_controller.h"
#include "tf/color_maps.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// From nothing where the map is 0 to the end of the colours and `strength` where it is largest.
QImage imageOf(const Plane& plane, double strength) {
    const ColorMap& colors = colorMapNamed("ember");
    std::vector<QRgb> table(256);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double part = static_cast<double>(i) / 255;
        QColor color = colorFromRgb(colors.colorAt(0.35 + 0.65 * part)); // without its darkest colours
        color.setAlphaF(static_cast<float>(strength * part));
        table[i] = qPremultiply(color.rgba());
    }
    const float top = std::max(*std::ranges::max_element(plane.values), 1e-9f);
    QImage image(plane.width, plane.height, QImage::Format_ARGB32_Premultiplied);
    for (int y = 0; y < plane.height; ++y) {
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < plane.width; ++x)
            line[x] = table[static_cast<std::size_t>(255 * std::clamp(plane.row(y)[x] / top, 0.0f, 1.0f))];
    }
    return image;
}

} // namespace

SaliencyLayer::SaliencyLayer(PictureSaliencyController& saliency, ViewOverlay& overlay) : m_saliency(saliency) {
    QObject::connect(&saliency, &PictureSaliencyController::changed, &overlay, [&overlay] { overlay.update(); });
}

void SaliencyLayer::paint(QPainter& painter, const LayerView& view) {
    if (m_version != m_saliency.version()) {
        m_version = m_saliency.version();
        const std::optional<Plane> map = m_saliency.map();
        m_image = map ? imageOf(*map, view.scene.session.pictureSaliency->strength) : QImage();
    }
    if (m_image.isNull() || !(view.scene.camera == m_saliency.picture().camera)) return; // a glimpse from elsewhere
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawImage(QRectF(QPointF(), view.size), m_image);
}

} // namespace pellucid::gui
