#include "widgets/shown_vision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <QGraphicsEffect>
#include <QImage>
#include <QPainter>
#include <QWidget>

#include "base/parallel.h"

namespace pellucid::gui {
namespace {

constexpr int kLightSteps = 1 << 14; ///< of linear light: fine enough for the darkest of 256 values

struct ScreenTables {
    std::array<float, 256> light{};                    ///< of each value of a screen
    std::array<std::uint8_t, kLightSteps + 1> value{}; ///< of light in steps
};

const ScreenTables& screenTables() {
    static const ScreenTables kTables = [] {
        ScreenTables tables;
        for (std::size_t i = 0; i < tables.light.size(); ++i)
            tables.light[i] = static_cast<float>(linearFromSrgb(static_cast<double>(i) / 255));
        for (std::size_t i = 0; i < tables.value.size(); ++i)
            tables.value[i] =
                static_cast<std::uint8_t>(std::lround(255 * srgbFromLinear(static_cast<double>(i) / kLightSteps)));
        return tables;
    }();
    return kTables;
}

/// Paints a widget with other colours.
class VisionEffect : public QGraphicsEffect {
public:
    using QGraphicsEffect::QGraphicsEffect;

protected:
    void draw(QPainter* painter) override {
        QPoint offset;
        const QPixmap source = sourcePixmap(Qt::LogicalCoordinates, &offset, NoPad);
        if (source.isNull()) return;
        QImage image = source.toImage();
        simulateVision(image, shownVision().matrix());
        painter->drawImage(offset, image);
    }
};

} // namespace

ShownVision& ShownVision::instance() {
    static ShownVision vision;
    return vision;
}

void ShownVision::show(VisionKind vision) {
    if (vision == m_vision) return;
    m_vision = vision;
    Q_EMIT changed();
}

void followShownVision(QWidget& widget) {
    const auto follow = [&widget] {
        if (shownVision().isNormal()) return widget.setGraphicsEffect(nullptr);
        if (widget.graphicsEffect() == nullptr) widget.setGraphicsEffect(new VisionEffect); // the widget owns it
        widget.update();
    };
    QObject::connect(&shownVision(), &ShownVision::changed, &widget, follow);
    follow();
}

void simulateVision(QImage& image, const LightMatrix& matrix) {
    image = std::move(image).convertToFormat(QImage::Format_ARGB32);
    std::array<std::array<float, 3>, 3> m{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t c = 0; c < 3; ++c) m[row][c] = static_cast<float>(matrix[row][c]);
    const ScreenTables& tables = screenTables();
    const auto height = static_cast<std::size_t>(image.height());
    const auto stride = static_cast<std::size_t>(image.bytesPerLine()) / sizeof(QRgb);
    auto* const pixels = reinterpret_cast<QRgb*>(image.bits());
    const int width = image.width();
    parallelFor(height, [&](std::size_t y) {
        QRgb* const line = pixels + y * stride;
        for (int x = 0; x < width; ++x) {
            const QRgb pixel = line[x];
            const float r = tables.light[static_cast<std::size_t>(qRed(pixel))],
                        g = tables.light[static_cast<std::size_t>(qGreen(pixel))],
                        b = tables.light[static_cast<std::size_t>(qBlue(pixel))];
            const auto seen = [&](std::size_t row) {
                const float light = std::clamp(m[row][0] * r + m[row][1] * g + m[row][2] * b, 0.0F, 1.0F);
                return int{tables.value[static_cast<std::size_t>(light * kLightSteps + 0.5F)]};
            };
            line[x] = qRgba(seen(0), seen(1), seen(2), qAlpha(pixel));
        }
    });
}

} // namespace pellucid::gui
