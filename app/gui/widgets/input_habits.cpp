#include "widgets/input_habits.h"

#include <algorithm>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QCursor>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QRegularExpression>
#include <QTimer>

namespace pellucid::gui {
namespace {

// The number box that an event is for, which may go to the line inside it.
QAbstractSpinBox* numberBox(QObject* watched) {
    if (auto* box = qobject_cast<QAbstractSpinBox*>(watched)) return box;
    return watched->parent() == nullptr ? nullptr : qobject_cast<QAbstractSpinBox*>(watched->parent());
}

// Whether something has been typed that is not taken yet.
bool isBeingTyped(QAbstractSpinBox& box) {
    const auto* line = box.findChild<QLineEdit*>();
    return line != nullptr && line->isModified();
}

void keepInside(QWidget& tip) {
    const QWidget* window = QApplication::activeWindow();
    if (window == nullptr) window = QApplication::topLevelAt(QCursor::pos());
    if (window == nullptr || window == &tip || !tip.isVisible()) return;
    const QRect room = window->frameGeometry();
    QPoint place = tip.pos();
    place.setX(std::max(room.left(), std::min(place.x(), room.right() - tip.width())));
    place.setY(std::max(room.top(), std::min(place.y(), room.bottom() - tip.height())));
    if (place != tip.pos()) tip.move(place);
}

constexpr auto kNamedByTip = "namedByTip"; ///< the name

/// What shows a value without saying what it is of.
bool needsName(const QWidget& widget) {
    if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) return button->text().isEmpty();
    const QWidget* parent = widget.parentWidget();
    if (qobject_cast<const QLineEdit*>(&widget) != nullptr)
        return qobject_cast<const QAbstractSpinBox*>(parent) == nullptr &&
               qobject_cast<const QComboBox*>(parent) == nullptr;
    return qobject_cast<const QAbstractSpinBox*>(&widget) != nullptr ||
           qobject_cast<const QAbstractSlider*>(&widget) != nullptr ||
           qobject_cast<const QComboBox*>(&widget) != nullptr ||
           qobject_cast<const QAbstractItemView*>(&widget) != nullptr;
}

/// Whether the toolkit calls it by a label; lists and tables it does not.
bool hasLabel(const QWidget& widget) {
    if (widget.parentWidget() == nullptr || qobject_cast<const QAbstractItemView*>(&widget) != nullptr) return false;
    const auto labels = widget.parentWidget()->findChildren<QLabel*>(QString(), Qt::FindDirectChildrenOnly);
    return std::ranges::any_of(labels, [&](const QLabel* label) { return label->buddy() == &widget; });
}

/// What nothing names is called by the first words of its tip, for those who hear it.
void nameByTip(QWidget& widget) {
    // What somebody has called it since counts more.
    const QString now = widget.accessibleName();
    if ((!now.isEmpty() && now != widget.property(kNamedByTip).toString()) || !needsName(widget)) return;
    static const QRegularExpression kEnd("[.,:;\n(]");
    const QString name = hasLabel(widget) ? QString() : widget.toolTip().section(kEnd, 0, 0).trimmed();
    widget.setProperty(kNamedByTip, name);
    widget.setAccessibleName(name);
}

} // namespace

bool InputHabits::eventFilter(QObject* watched, QEvent* event) {
    switch (event->type()) {
    case QEvent::ShortcutOverride: {
        const auto* key = static_cast<QKeyEvent*>(event);
        // What has the focus and is worked with Space keeps it; it says so itself, or is one of the toolkit's.
        if (key->key() == Qt::Key_Space && key->modifiers() == Qt::NoModifier &&
            (qobject_cast<QAbstractButton*>(watched) != nullptr ||
             qobject_cast<QAbstractItemView*>(watched) != nullptr || qobject_cast<QComboBox*>(watched) != nullptr ||
             watched->property(kKeepsSpace).toBool())) {
            event->accept();
            return true;
        }
        // No number has a letter in it.
        const bool isLetter = key->modifiers() == Qt::NoModifier && key->key() >= Qt::Key_A && key->key() <= Qt::Key_Z;
        if (!isLetter && !key->matches(QKeySequence::Undo) && !key->matches(QKeySequence::Redo)) break;
        QAbstractSpinBox* box = numberBox(watched);
        if (box == nullptr || isBeingTyped(*box)) break;
        event->ignore(); // let the shortcut have it
        return true;
    }
    case QEvent::KeyPress:
        // A number is finished with Enter, and by then nothing is being typed.
        if (const int key = static_cast<QKeyEvent*>(event)->key(); key == Qt::Key_Return || key == Qt::Key_Enter)
            if (QAbstractSpinBox* box = numberBox(watched))
                QTimer::singleShot(0, box, [box] {
                    if (auto* line = box->findChild<QLineEdit*>()) line->setModified(false);
                });
        break;
    case QEvent::ToolTipChange:
        if (watched->isWidgetType()) nameByTip(*static_cast<QWidget*>(watched));
        break;
    case QEvent::Show:
        // Tab goes on to the next control; arrow keys go from cell to cell.
        if (auto* cells = qobject_cast<QAbstractItemView*>(watched)) cells->setTabKeyNavigation(false);
        if (watched->isWidgetType()) nameByTip(*static_cast<QWidget*>(watched));
        [[fallthrough]];
    case QEvent::Resize:
        if (watched->inherits("QTipLabel"))
            QTimer::singleShot(0, watched, [tip = static_cast<QWidget*>(watched)] { keepInside(*tip); });
        break;
    default:
        break;
    }
    return QObject::eventFilter(watched, event);
}

} // namespace pellucid::gui
