// Whose eyes the window is shown for: everybody's, or those of a viewer with a colour-vision deficiency. What is saved
// stays as it is.
#pragma once

#include <QObject>

#include "tf/color_vision.h"

class QImage;
class QWidget;

namespace pellucid::gui {

/// One for the program, as the theme is; normal at each start.
class ShownVision : public QObject {
    Q_OBJECT
public:
    static ShownVision& instance();

    VisionKind vision() const { return m_vision; }
    bool isNormal() const { return m_vision == VisionKind::Normal; }
    LightMatrix matrix() const { return visionMatrix(m_vision); }
    void show(VisionKind vision);

Q_SIGNALS:
    void changed();

private:
    VisionKind m_vision = VisionKind::Normal;
};

inline ShownVision& shownVision() { return ShownVision::instance(); }

/// The widget and all that lies in it look as that viewer sees them, from now on. Nothing in it may draw by OpenGL.
void followShownVision(QWidget& widget);

/// Of 8 bits per channel. For what is on the screen: rounded to its values.
void simulateVision(QImage& image, const LightMatrix& matrix);

} // namespace pellucid::gui
