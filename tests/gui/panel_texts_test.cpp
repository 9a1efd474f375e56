// Every panel at 1280 x 800: its texts have room, nothing lies on top of something else, and nothing must be scrolled
// sideways; at the scale of 1 and, in processes of their own, of 2 and 3.
#include "gui_support.h"

#include <QCoreApplication>
#include <QDockWidget>
#include <QProcess>
#include <QPushButton>
#include <QSettings>

#include "panels/panel.h"
#include "support/cut_texts.h"
#include "widgets/theme.h"
#include "window/room.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// A window of that size on a series, so that all panels have something to show.
struct SeriesWindow : OpenWindow {
    SeriesWindow() {
        window.resize(1280, 800);
        VolumeSource source;
        source.path = "sample:vortex";
        source.sampleSize = 24;
        open(source);
        // From far away, so that the picture, which is not what is looked at, takes no time.
        Camera camera = document().camera();
        camera.eye = camera.center + 8.0 * (camera.eye - camera.center);
        document().setCamera(camera);
        settle();
    }
};

void checkPanels() {
    SeriesWindow w;
    for (const PanelInfo& panel : panelRegistry()) {
        INFO("panel " << panel.id);
        w.window.room().reset();
        auto& dock = w.child<QDockWidget>((std::string(panel.id) + "Dock").c_str());
        if (!dock.isVisible() || dock.visibleRegion().isEmpty())
            w.child<QAction>((std::string(panel.id) + "Action").c_str()).trigger();
        QTest::qWait(60);
        w.settle();
        QTest::qWait(60);
        CHECK(dock.isVisible());
        CHECK(cutTexts(dock).join("\n").toStdString() == "");
        CHECK(overlaps(dock).join("\n").toStdString() == "");
        CHECK(scrolledSideways(dock).join("\n").toStdString() == "");
    }
    QSettings().clear();
}

/// Runs the hidden test below at another scale; what it says where it fails.
void checkAtScale(const char* scale) {
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert("QT_SCALE_FACTOR", scale);
    process.setProcessEnvironment(environment);
    process.setProcessChannelMode(QProcess::MergedChannels);
    process.start(QCoreApplication::applicationFilePath(), {"[panel-texts-here]"});
    REQUIRE(process.waitForFinished(4 * kPatience));
    INFO(process.readAll().toStdString());
    CHECK(process.exitStatus() == QProcess::NormalExit);
    CHECK(process.exitCode() == 0);
}

} // namespace

TEST_CASE("a text that is cut off is found", "[layout]") {
    QWidget parent;
    parent.resize(300, 200);
    auto* label = new QLabel("A long text that needs its room", &parent);
    label->setGeometry(0, 0, 40, 20);
    auto* button = new QPushButton("Optimize everything", &parent);
    button->setGeometry(0, 40, 60, 24);
    auto* box = new QComboBox(&parent);
    box->addItem("a choice of many words");
    box->setGeometry(0, 80, 60, 24);
    parent.show();
    CHECK(cutTexts(parent).size() == 3);
    CHECK(overlaps(parent).isEmpty());
    for (QWidget* widget : {static_cast<QWidget*>(label), static_cast<QWidget*>(button), static_cast<QWidget*>(box)})
        widget->resize(280, 30);
    CHECK(cutTexts(parent).join("\n").toStdString() == "");
    label->setGeometry(0, 30, 280, 30);
    CHECK(overlaps(parent).size() == 1);
    label->setGeometry(0, 0, 280, 4); // too low
    CHECK(cutTexts(parent).size() == 1);
}

TEST_CASE("what must be scrolled sideways is found", "[layout]") {
    QWidget parent;
    parent.setObjectName("narrow");
    auto* area = new QScrollArea(&parent);
    auto* content = new QWidget;
    content->setMinimumWidth(300);
    area->setWidget(content);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setGeometry(0, 0, 260, 100);
    parent.show();
    QTest::qWait(20);
    CHECK(scrolledSideways(parent) == QStringList{"narrow: 40"});
    area->resize(300, 100);
    QTest::qWait(20);
    CHECK(scrolledSideways(parent).isEmpty());
}

TEST_CASE("the texts of every panel have room at 1280 x 800", "[layout][panel-texts]") { checkPanels(); }

TEST_CASE("the texts of every panel have room at twice the scale", "[layout][panel-texts][program]") {
    checkAtScale("2");
}

TEST_CASE("the texts of every panel have room at three times the scale", "[layout][panel-texts][program]") {
    checkAtScale("3");
}

// Started by those above.
TEST_CASE("the texts of every panel have room at the scale of this process", "[.][panel-texts-here]") { checkPanels(); }
