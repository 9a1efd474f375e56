// A slider that makes everything denser or thinner.
#pragma once

#include <QWidget>

#include "store/session_store.h"

class QLabel;
class QSlider;

namespace pellucid::gui {

/// While it is held, the picture shows the factor; when it is let go, that is one undo step and the slider is back at
/// × 1. Keys move it by a tenth of a doubling; those in a row are one step.
class DensitySlider : public QWidget {
    Q_OBJECT
public:
    explicit DensitySlider(SessionStore& store, QWidget* parent = nullptr);

    double factor() const; ///< [1/16, 16]

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void follow();
    void springBack();

    SessionStore& m_store;
    QSlider* m_slider; ///< hundredths of doublings
    QLabel* m_factor;
    bool m_givenUp = false; ///< Escape was pressed while the mouse still holds the slider
};

} // namespace pellucid::gui
