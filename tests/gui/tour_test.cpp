// The tour of the window: five steps beside the controls that they are about, left at any time.
#include "gui_support.h"

#include <QAction>
#include <QDockWidget>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QSettings>

#include "support/cut_texts.h"
#include "window/tour.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

Tour& openTour(OpenWindow& w) {
    w.child<QAction>("tourAction").trigger();
    return w.child<Tour>("tour");
}

/// Where a widget lies in the window.
QRect placeIn(const OpenWindow& w, const QWidget& widget) {
    return {widget.mapTo(&w.window, QPoint(0, 0)), widget.size()};
}

struct UnseenAgain {
    ~UnseenAgain() { QSettings().remove("tourSeen"); }
};

} // namespace

TEST_CASE("the tour points at the real controls, step by step", "[tour]") {
    const UnseenAgain unseen;
    OpenWindow w;
    w.window.resize(1280, 800);
    w.settle();
    w.child<QDockWidget>("featuresDock").hide(); // it opens what it speaks of
    Tour& tour = openTour(w);
    const char* const targets[] = {nullptr, "targetBars", "optimizeButton", "volumeView", nullptr};
    QStringList titles;
    for (int step = 0; step < Tour::stepCount(); ++step) {
        INFO("step " << step + 1);
        QTest::qWait(60);
        REQUIRE(tour.step() == step);
        REQUIRE(tour.target() != nullptr);
        CHECK(tour.target()->isVisible());
        if (targets[step] != nullptr) CHECK(tour.target()->objectName() == targets[step]);
        const QRect card = placeIn(w, tour), mark = placeIn(w, w.child<QWidget>("tourMark"));
        CHECK(w.window.rect().contains(card));
        CHECK(mark.intersects(placeIn(w, *tour.target())));
        // Beside it; over the picture alone, which has all the room around it.
        if (step != 3) CHECK_FALSE(card.intersects(mark));
        CHECK(cutTexts(tour).isEmpty());
        CHECK(tour.accessibleName().contains(QStringLiteral("%1 of 5").arg(step + 1)));
        CHECK(tour.accessibleDescription() == w.child<QLabel>("tourText").text());
        titles << w.child<QLabel>("tourTitle").text();
        if (step + 1 < Tour::stepCount()) QTest::mouseClick(&w.child<QPushButton>("tourNext"), Qt::LeftButton);
    }
    CHECK(titles.removeDuplicates() == 0);
    CHECK(w.child<QPushButton>("tourNext").text() == "Done");
    const QPointer<Tour> open(&tour);
    QTest::mouseClick(&w.child<QPushButton>("tourNext"), Qt::LeftButton);
    REQUIRE(waitFor([&] { return open.isNull(); }));
    CHECK(w.window.findChild<QWidget*>("tourMark") == nullptr);
    CHECK(Tour::wasSeen());
}

TEST_CASE("the tour is walked by keys, and Esc leaves it from anywhere", "[tour]") {
    const UnseenAgain unseen;
    OpenWindow w;
    w.window.activateWindow();
    REQUIRE(QTest::qWaitForWindowActive(&w.window, kPatience));
    w.view().setFocus();
    CHECK_FALSE(Tour::wasSeen());
    Tour& tour = openTour(w);
    auto& next = w.child<QPushButton>("tourNext");
    CHECK(next.hasFocus());
    CHECK(next.accessibleDescription().contains("Open your data"));
    QTest::keyClick(&next, Qt::Key_Right);
    CHECK(tour.step() == 1);
    QTest::keyClick(&next, Qt::Key_Space);
    CHECK(tour.step() == 2);
    QTest::keyClick(&next, Qt::Key_Left);
    CHECK(tour.step() == 1);
    // The window can be used meanwhile: arrow keys in the picture turn it, and the tour stays where it is.
    const Camera before = w.document().camera();
    w.view().setFocus();
    QTest::keyClick(&w.view(), Qt::Key_Right);
    CHECK_FALSE(w.document().camera() == before);
    CHECK(tour.step() == 1);
    const QPointer<Tour> open(&tour);
    QTest::keyClick(&w.view(), Qt::Key_Escape);
    REQUIRE(waitFor([&] { return open.isNull(); }));
    CHECK(w.view().hasFocus());
    CHECK(Tour::wasSeen());
}

TEST_CASE("a window can be closed with the tour open", "[tour]") {
    const UnseenAgain unseen;
    QPointer<Tour> open;
    {
        OpenWindow w;
        open = &openTour(w);
        REQUIRE_FALSE(open.isNull());
    }
    CHECK(open.isNull());
    CHECK_FALSE(Tour::wasSeen()); // nobody has left it
}

TEST_CASE("the card of the first start offers the tour until it has been seen", "[tour]") {
    const UnseenAgain unseen;
    QSettings().remove("welcomeCardSeen");
    OpenWindow w;
    w.window.welcome();
    auto& offer = w.child<QPushButton>("welcomeTour");
    REQUIRE(offer.isVisible());
    CHECK(cutTexts(w.child<QWidget>("welcomeCard")).join("\n").toStdString() == "");
    QTest::mouseClick(&offer, Qt::LeftButton);
    auto& tour = w.child<Tour>("tour");
    CHECK(tour.isVisible());
    CHECK(QSettings().value("welcomeCardSeen").toBool());
    // Asked for once more it is the one that is open.
    w.child<QAction>("tourAction").trigger();
    CHECK(w.window.findChildren<Tour*>().size() == 1);
    QTest::mouseClick(&w.child<QPushButton>("tourLeave"), Qt::LeftButton);
    REQUIRE(waitFor(
        [&] { return w.window.findChild<Tour*>() == nullptr && !w.window.findChild<QWidget*>("welcomeCard"); }));
    QSettings().remove("welcomeCardSeen");
    w.window.welcome();
    CHECK(w.window.findChild<QPushButton*>("welcomeTour") == nullptr);
    QSettings().setValue("welcomeCardSeen", true);
}
