#include "widgets/dock_title.h"

#include <QDockWidget>
#include <QPainter>
#include <QStyle>

#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/fitting_row.h"
#include "widgets/layouts.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kHeight = 24, kButton = 16; // logical pixels

QToolButton* dockButton(QStyle::StandardPixmap sign, const QString& id, const QString& tip, QWidget* parent) {
    auto* button = named(new QToolButton(parent), id, tip);
    button->setIcon(parent->style()->standardIcon(sign, nullptr, parent));
    button->setIconSize({kButton, kButton});
    button->setFixedSize(kButton, kButton);
    button->setAutoRaise(true);
    button->setFocusPolicy(Qt::TabFocus); // a click leaves the keys where they are
    button->setAccessibleName(tip);
    return button;
}

} // namespace

DockTitle::DockTitle(QDockWidget& dock) : QWidget(&dock), m_controls(new FittingRow(6)) {
    setObjectName("dockTitle");
    auto* name = named(new ElidedLabel(dock.windowTitle(), this), "dockTitleName");
    connect(&dock, &QDockWidget::windowTitleChanged, name, &QLabel::setText);
    auto* apart = dockButton(QStyle::SP_TitleBarNormalButton, "dockFloat",
                             tr("A window of its own, or back into this one"), this);
    connect(apart, &QToolButton::clicked, &dock, [&dock] { dock.setFloating(!dock.isFloating()); });
    auto* close = dockButton(QStyle::SP_TitleBarCloseButton, "dockClose", tr("Close the panel"), this);
    connect(close, &QToolButton::clicked, &dock, &QDockWidget::close);
    auto* row = inset(rowOf({name}, 8), {8, 0, 4, 0});
    row->addLayout(m_controls, 1);
    add(*row, {apart, close});
    setLayout(row);
}

DockTitle* DockTitle::of(QWidget* dock) {
    auto* const known = qobject_cast<QDockWidget*>(dock);
    return known == nullptr ? nullptr : qobject_cast<DockTitle*>(known->titleBarWidget());
}

QSize DockTitle::sizeHint() const { return {QWidget::sizeHint().width(), kHeight}; }

void DockTitle::paintEvent(QPaintEvent*) { QPainter(this).fillRect(rect(), theme::kTitle); }

} // namespace pellucid::gui
