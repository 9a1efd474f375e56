#include "window/welcome_card.h"

#include <QPushButton>
#include <QSettings>

#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "window/tour.h"

namespace pellucid::gui {
namespace {

constexpr auto kSeenKey = "welcomeCardSeen";
constexpr int kWidth = 230; // logical pixels: what the picture beside it can do without

} // namespace

WelcomeCard::WelcomeCard(QWidget* parent) : QFrame(parent) {
    setObjectName("welcomeCard");
    setAutoFillBackground(true);
    setFrameShape(QFrame::StyledPanel);
    QLabel* title = wrappedLabel("welcomeTitle", this);
    title->setText(tr("<b>This is a sample.</b> Three things to try:"));
    QLabel* things = wrappedLabel("welcomeThings", this);
    things->setText(
        tr("<ul style='margin-left: 14px; -qt-list-indent: 0;'>"
           "<li>Drop a file of your own onto the window, or press Ctrl+O.</li>"
           "<li>Click on a thing in the picture: what is it, and how much of it is seen?</li>"
           "<li>Drag the white handle on a feature's bar, then press Optimize: the feature gets that share of "
           "attention.</li></ul>"));
    auto* close = named(new QPushButton(tr("Got it"), this), "welcomeClose", tr("This card will not be shown again"));
    connect(close, &QPushButton::clicked, this, &WelcomeCard::dismiss);
    auto* tour = named(new QPushButton(tr("Take the tour"), this), "welcomeTour",
                       tr("The window in five steps, which you can leave; also in the menu Help"));
    connect(tour, &QPushButton::clicked, this, [this] {
        dismiss();
        Q_EMIT tourWanted();
    });
    tour->setVisible(!Tour::wasSeen());
    setLayout(inset(columnOf({title, things, tour, rowOf({Cell::rest(), close}), Cell::rest()}), {14, 12, 14, 12}));
    setFixedWidth(kWidth);
}

bool WelcomeCard::isWanted() { return !QSettings().value(kSeenKey, false).toBool(); }

void WelcomeCard::dismiss() {
    QSettings().setValue(kSeenKey, true);
    hide();
    deleteLater();
}

} // namespace pellucid::gui
