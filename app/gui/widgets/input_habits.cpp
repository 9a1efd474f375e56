#include "widgets/input_habits.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QCursor>
#include <QKeyEvent>
#include <QLineEdit>
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
    case QEvent::Show:
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
