// Texts of controls that there is not room for: what a test of panels and those who look at their pictures search for.
#pragma once

#include <algorithm>

#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QCheckBox>
#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QRadioButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QStringList>
#include <QStyle>
#include <QStyleOptionComboBox>
#include <QTextDocument>
#include <QToolButton>

#include "widgets/elided.h"
#include "widgets/fitting_row.h"

namespace pellucid::gui {

/// Logical pixels.
struct RoomForText {
    QString text;
    int needed = 0, given = 0; ///< widths
    int neededHeight = 0, givenHeight = 0;
    bool isCut() const { return needed > given || neededHeight > givenHeight; }
};

inline QString withoutMnemonic(QString text) { return text.remove('&'); }

inline RoomForText roomOf(const QLabel& label) {
    if (dynamic_cast<const ElidedLabel*>(&label) != nullptr || label.text().isEmpty()) return {};
    const QRect rect = label.contentsRect().adjusted(label.margin(), label.margin(), -label.margin(), -label.margin());
    QTextDocument document;
    document.setDefaultFont(label.font());
    document.setDocumentMargin(0);
    if (Qt::mightBeRichText(label.text()))
        document.setHtml(label.text());
    else
        document.setPlainText(withoutMnemonic(label.text()));
    if (label.wordWrap()) document.setTextWidth(rect.width());
    // Wrapped, its widest word must have room; what a line has above and below its letters need not.
    const int slack = 2;
    return {label.text(), static_cast<int>(document.idealWidth()), rect.width() + 1,
            static_cast<int>(document.size().height()) - slack, rect.height()};
}

inline RoomForText roomOf(const QAbstractButton& button) {
    if (button.text().isEmpty()) return {};
    const auto* tool = qobject_cast<const QToolButton*>(&button);
    if (tool != nullptr && (tool->toolButtonStyle() == Qt::ToolButtonIconOnly && !tool->icon().isNull())) return {};
    const bool hasMark =
        qobject_cast<const QCheckBox*>(&button) != nullptr || qobject_cast<const QRadioButton*>(&button) != nullptr;
    const QFontMetrics metrics = button.fontMetrics();
    int needed = metrics.horizontalAdvance(withoutMnemonic(button.text())) + 2;
    if (hasMark) needed = button.sizeHint().width();
    if (tool != nullptr && tool->popupMode() != QToolButton::DelayedPopup) needed += 10; // the arrow
    if (!hasMark && !button.icon().isNull() &&
        (tool == nullptr || tool->toolButtonStyle() == Qt::ToolButtonTextBesideIcon))
        needed += button.iconSize().width();
    return {button.text(), needed, button.width(), metrics.ascent(), button.height()};
}

inline RoomForText roomOf(const QComboBox& box) {
    QStyleOptionComboBox option;
    option.initFrom(&box);
    option.editable = box.isEditable();
    option.frame = box.hasFrame();
    const QRect field = box.style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField, &box);
    const QFontMetrics metrics = box.fontMetrics();
    return {box.currentText(), metrics.horizontalAdvance(box.currentText()), field.width(), metrics.ascent(),
            field.height()};
}

inline RoomForText roomOf(const QAbstractSpinBox& box) {
    const auto* const line = box.findChild<QLineEdit*>();
    if (line == nullptr) return {};
    const QFontMetrics metrics = line->fontMetrics();
    return {box.text(), metrics.horizontalAdvance(box.text()), line->contentsRect().width(), metrics.ascent(),
            box.height()};
}

inline RoomForText roomOf(const QGroupBox& box) {
    const QFontMetrics metrics = box.fontMetrics();
    return {box.title(), metrics.horizontalAdvance(withoutMnemonic(box.title())), box.width(), 0, 0};
}

inline RoomForText roomOfText(const QWidget& widget) {
    if (const auto* label = qobject_cast<const QLabel*>(&widget)) return roomOf(*label);
    if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) return roomOf(*button);
    if (const auto* box = qobject_cast<const QComboBox*>(&widget)) return roomOf(*box);
    if (const auto* box = qobject_cast<const QAbstractSpinBox*>(&widget)) return roomOf(*box);
    if (const auto* box = qobject_cast<const QGroupBox*>(&widget)) return roomOf(*box);
    return {};
}

/// "densityLabel 'Density': 40 x 14 of 38 x 16" of each text in `root` that is shown and cut off.
inline QStringList cutTexts(const QWidget& root) {
    QStringList cut;
    for (const QWidget* widget : root.findChildren<QWidget*>()) {
        if (!widget->isVisible() || FittingRow::isLeftOut(*widget)) continue;
        const RoomForText room = roomOfText(*widget);
        if (room.isCut())
            cut << QStringLiteral("%1 '%2': %3 x %4 of %5 x %6")
                       .arg(widget->objectName().isEmpty() ? QString(widget->metaObject()->className())
                                                           : widget->objectName(),
                            room.text)
                       .arg(room.needed)
                       .arg(room.neededHeight)
                       .arg(room.given)
                       .arg(room.givenHeight);
    }
    return cut;
}

/// "displayPanel: 40" of each part of `root` that must be scrolled sideways to be seen, and by how many logical pixels.
/// Lists and tables, which are as wide as their texts, are left out.
inline QStringList scrolledSideways(const QWidget& root) {
    QStringList found;
    for (const QScrollArea* area : root.findChildren<QScrollArea*>())
        if (area->isVisible() && area->horizontalScrollBar()->maximum() > 0)
            found << QStringLiteral("%1: %2")
                         .arg(area->parentWidget()->objectName())
                         .arg(area->horizontalScrollBar()->maximum());
    return found;
}

/// Pairs of controls beside each other in one parent that overlap.
inline QStringList overlaps(const QWidget& root) {
    QStringList found;
    const auto isControl = [](const QWidget* w) {
        return w->isVisible() && !FittingRow::isLeftOut(*w) &&
               (qobject_cast<const QAbstractButton*>(w) || qobject_cast<const QLabel*>(w) ||
                qobject_cast<const QComboBox*>(w) || qobject_cast<const QAbstractSpinBox*>(w));
    };
    for (const QWidget* a : root.findChildren<QWidget*>())
        if (isControl(a) && a->parentWidget() != nullptr)
            for (const QWidget* b : a->parentWidget()->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly))
                if (a < b && isControl(b) && a->geometry().intersects(b->geometry()))
                    found << a->objectName() + " and " + b->objectName();
    return found;
}

} // namespace pellucid::gui
