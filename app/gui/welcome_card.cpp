#include "welcome_card.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

namespace pellucid::gui {
namespace {

constexpr auto kSeenKey = "welcomeCardSeen";
constexpr int kMargin = 16, kWidth = 330; // logical pixels

} // namespace

WelcomeCard::WelcomeCard(QWidget* view) : QFrame(view->parentWidget()), m_view(view) {
    setObjectName("welcomeCard");
    setAutoFillBackground(true);
    setFrameShape(QFrame::StyledPanel);
    setAttribute(Qt::WA_NoMousePropagation);
    auto* title = new QLabel(tr("<b>This is a sample.</b> Three things to try:"), this);
    title->setObjectName("welcomeTitle");
    auto* things = new QLabel(tr("<ul style='margin-left: 14px; -qt-list-indent: 0;'>"
                                 "<li>Drop a file of your own here, or press Ctrl+O.</li>"
                                 "<li>Click on a thing in the picture: what is it, and how much of it is seen?</li>"
                                 "<li>Drag a target in the table of features, then press Optimize: the picture shows "
                                 "that much of it.</li></ul>"),
                              this);
    things->setObjectName("welcomeThings");
    things->setWordWrap(true);
    auto* close = new QPushButton(tr("Got it"), this);
    close->setObjectName("welcomeClose");
    close->setToolTip(tr("This card does not come again"));
    connect(close, &QPushButton::clicked, this, &WelcomeCard::dismiss);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(14, 12, 14, 12);
    column->addWidget(title);
    column->addWidget(things);
    auto* row = new QHBoxLayout;
    row->addStretch(1);
    row->addWidget(close);
    column->addLayout(row);
    setFixedWidth(kWidth);
    view->installEventFilter(this);
    place();
    show();
    raise();
}

bool WelcomeCard::isWanted() { return !QSettings().value(kSeenKey, false).toBool(); }

void WelcomeCard::dismiss() {
    QSettings().setValue(kSeenKey, true);
    hide();
    deleteLater();
}

bool WelcomeCard::eventFilter(QObject* watched, QEvent* event) {
    if (watched == m_view && (event->type() == QEvent::Resize || event->type() == QEvent::Move)) place();
    return QFrame::eventFilter(watched, event);
}

void WelcomeCard::place() {
    resize(kWidth, heightForWidth(kWidth) > 0 ? heightForWidth(kWidth) : sizeHint().height());
    move(m_view->geometry().bottomLeft() + QPoint(kMargin, -height() - kMargin));
}

} // namespace pellucid::gui
