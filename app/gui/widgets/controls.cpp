#include "widgets/controls.h"

#include <QHelpEvent>
#include <QMenu>
#include <QToolTip>

namespace pellucid::gui {

QToolButton* toolButton(const QString& text, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setText(text);
    return button;
}

QToolButton* menuButton(const QString& text, QWidget* parent) {
    QToolButton* button = toolButton(text + QStringLiteral(" ▾"), parent);
    button->setStyleSheet("QToolButton::menu-indicator { image: none; }"); // the text has one
    button->setPopupMode(QToolButton::InstantPopup);
    auto* menu = new QMenu(button);
    menu->setToolTipsVisible(true);
    button->setMenu(menu);
    return button;
}

QLabel* wrappedLabel(const QString& id, QWidget* parent) {
    QLabel* label = named(new QLabel(parent), id);
    label->setWordWrap(true);
    return label;
}

QLabel* withAnyWidth(QLabel* label) {
    label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    return label;
}

void makeBold(QWidget& widget) {
    QFont bold = widget.font();
    bold.setBold(true);
    widget.setFont(bold);
}

QProgressBar* progressBar(const QString& id, QWidget* parent, int most) {
    QProgressBar* bar = named(new QProgressBar(parent), id);
    bar->setRange(0, most);
    bar->setTextVisible(false);
    return bar;
}

QDoubleSpinBox* withLook(QDoubleSpinBox* box, const NumberLook& look) {
    box->setDecimals(look.decimals);
    box->setRange(look.lo, look.hi);
    box->setSingleStep(look.step);
    box->setSuffix(look.suffix);
    box->setKeyboardTracking(false);
    return box;
}

void addItem(QComboBox& box, const QString& text, const QVariant& data, const QString& tip) {
    box.addItem(text, data);
    box.setItemData(box.count() - 1, tip, Qt::ToolTipRole);
}

QPixmap swatchOf(const QColor& color, int width, int height) {
    QPixmap swatch(width, height);
    swatch.fill(color);
    return swatch;
}

bool showsTip(QEvent& event, QWidget& widget, const std::function<QString(const QPoint&)>& textAt) {
    if (event.type() != QEvent::ToolTip) return false;
    const auto& help = static_cast<QHelpEvent&>(event);
    QToolTip::showText(help.globalPos(), textAt(help.pos()), &widget);
    return true;
}

} // namespace pellucid::gui
