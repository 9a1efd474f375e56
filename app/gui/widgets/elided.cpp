#include "widgets/elided.h"

#include <QAbstractItemView>
#include <QApplication>
#include <QHelpEvent>
#include <QStyleOption>
#include <QStylePainter>
#include <QToolTip>

namespace pellucid::gui {
namespace {

QString whole(const QString& text, const QString& tip) {
    return tip.isEmpty() || tip == text ? text : text + "\n" + tip;
}

/// Whether the cell is too narrow for its text.
bool isCut(const QAbstractItemView& view, const QModelIndex& index) {
    const QString text = index.data(Qt::DisplayRole).toString();
    if (text.isEmpty()) return false;
    const QVariant font = index.data(Qt::FontRole);
    const QFontMetrics metrics(font.isValid() ? font.value<QFont>() : view.font());
    const int margin = 2 * (view.style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, &view) + 1);
    const bool hasMark = index.data(Qt::DecorationRole).isValid();
    const int mark =
        hasMark ? view.style()->pixelMetric(QStyle::PM_SmallIconSize, nullptr, &view) + margin : 0; // icon or colour
    return metrics.horizontalAdvance(text) + margin + mark > view.visualRect(index).width();
}

/// Says the whole text of cells.
class WholeTexts : public QObject {
public:
    explicit WholeTexts(QAbstractItemView& view) : QObject(&view), m_view(view) {
        view.viewport()->installEventFilter(this);
    }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (event->type() != QEvent::ToolTip) return QObject::eventFilter(watched, event);
        const auto& help = static_cast<QHelpEvent&>(*event);
        const QModelIndex index = m_view.indexAt(help.pos());
        if (!index.isValid() || !isCut(m_view, index)) return false; // the view says what there is to say
        QToolTip::showText(help.globalPos(),
                           whole(index.data(Qt::DisplayRole).toString(), index.data(Qt::ToolTipRole).toString()),
                           &m_view, m_view.visualRect(index));
        return true;
    }

private:
    QAbstractItemView& m_view;
};

} // namespace

bool ElidedLabel::isElided() const { return fontMetrics().horizontalAdvance(text()) > contentsRect().width(); }

bool ElidedLabel::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip || !isElided()) return QLabel::event(event);
    QToolTip::showText(static_cast<QHelpEvent*>(event)->globalPos(), whole(text(), toolTip()), this);
    return true;
}

void ElidedLabel::paintEvent(QPaintEvent*) {
    QStylePainter painter(this);
    const QRect r = contentsRect();
    painter.drawItemText(r, static_cast<int>(alignment()), palette(), isEnabled(),
                         fontMetrics().elidedText(text(), Qt::ElideMiddle, r.width()), foregroundRole());
}

void elideInTheMiddle(QAbstractItemView& view) {
    view.setTextElideMode(Qt::ElideMiddle);
    new WholeTexts(view);
}

} // namespace pellucid::gui
