#include "window/welcome_card.h"

#include "widgets/named.h"
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

namespace pellucid::gui {
namespace {

constexpr auto kSeenKey = "welcomeCardSeen";
constexpr int kWidth = 230; // logical pixels: what the picture beside it can do without

} // namespace

WelcomeCard::WelcomeCard(QWidget* parent) : QFrame(parent) {
    setObjectName("welcomeCard");
    setAutoFillBackground(true);
    setFrameShape(QFrame::StyledPanel);
    auto* title = new QLabel(tr("<b>This is a sample.</b> Three things to try:"), this);
    title->setObjectName("welcomeTitle");
    title->setWordWrap(true);
    auto* things = new QLabel(tr("<ul style='margin-left: 14px; -qt-list-indent: 0;'>"
                                 "<li>Drop a file of your own onto the window, or press Ctrl+O.</li>"
                                 "<li>Click on a thing in the picture: what is it, and how much of it is seen?</li>"
                                 "<li>Drag a target in the table of features, then press Optimize: the picture shows "
                                 "that much of it.</li></ul>"),
                              this);
    things->setObjectName("welcomeThings");
    things->setWordWrap(true);
    auto* close = new QPushButton(tr("Got it"), this);
    named(close, "welcomeClose", tr("This card does not come again"));
    connect(close, &QPushButton::clicked, this, &WelcomeCard::dismiss);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(14, 12, 14, 12);
    column->addWidget(title);
    column->addWidget(things);
    auto* row = new QHBoxLayout;
    row->addStretch(1);
    row->addWidget(close);
    column->addLayout(row);
    column->addStretch(1);
    setFixedWidth(kWidth);
}

bool WelcomeCard::isWanted() { return !QSettings().value(kSeenKey, false).toBool(); }

void WelcomeCard::dismiss() {
    QSettings().setValue(kSeenKey, true);
    hide();
    deleteLater();
}

} // namespace pellucid::gui
