// Controls as panels have them.
#pragma once

#include <functional>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>

#include "widgets/named.h"

class QEvent;

namespace pellucid::gui {

QToolButton* toolButton(const QString& text, QWidget* parent);
/// A press opens its menu, button->menu(), as an arrow after the text says, which shows the tool tips of its entries.
QToolButton* menuButton(const QString& text, QWidget* parent);

/// A text of several lines.
QLabel* wrappedLabel(const QString& id, QWidget* parent);
/// As wide as there is room: what a label says must not change how wide its dock is, else the picture is drawn anew.
QLabel* withAnyWidth(QLabel* label);
void makeBold(QWidget& widget);

/// From 0 to `most`, without a text.
QProgressBar* progressBar(const QString& id, QWidget* parent, int most = 100);

/// What is typed counts when it is finished.
struct NumberLook {
    double lo = 0, hi = 1;
    int decimals = 0;
    double step = 1;
    QString suffix = {};
};
QDoubleSpinBox* withLook(QDoubleSpinBox* box, const NumberLook& look);

/// An entry of a list with its tool tip.
void addItem(QComboBox& box, const QString& text, const QVariant& data, const QString& tip);

/// An area of one colour, logical pixels.
QPixmap swatchOf(const QColor& color, int width, int height);

/// Of a tool tip's event: shows the text for the place of the mouse, or hides it where that is empty, and is true.
bool showsTip(QEvent& event, QWidget& widget, const std::function<QString(const QPoint&)>& textAt);

} // namespace pellucid::gui
