// Pictures of the window in any state, and how its room is shared out; for the guide, and for people who change how the
// window looks.
//
//     window_pictures [--size WxH] [--theme NAME] [--sample-size N] [--areas] [--out FILE.png] [--panels PREFIX]
//     DOCUMENT [STEP…]
//
// DOCUMENT is opened as the window opens it. A STEP is the name of an action, which is triggered, or one of
//     click:NAME          a press on a button
//     set:NAME=VALUE      a number, a choice or a text into a control
//     select:N            feature N, from 0
//     at:NAME=X,Y         a click on a widget, X and Y in parts of its width and height
//     overlay:FILE        a second volume over the first
//     of:NAME             the picture is of this widget alone
//     dialog:NAME         last: the action opens a dialog, of which the picture is
// --panels takes a picture of the window with each panel opened by its action, PREFIX-ID.png, and prints texts that are
// cut off; the camera is far away, so that this takes no long time. --areas prints what picture, plot and bars have of
// the window, in logical pixels.
#include <cstdio>
#include <stdexcept>

#include <QAbstractButton>
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QCommandLineParser>
#include <QDialog>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QSettings>
#include <QSlider>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/target_bars.h"
#include "support/cut_texts.h"
#include "tf/tf_canvas.h"
#include "widgets/theme.h"
#include "window/main_window.h"
#include "window/room.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kPatience = 300000, kRest = 150; // milliseconds

template <class T>
T& found(MainWindow& window, const QString& name) {
    T* const child = window.findChild<T*>(name);
    if (child == nullptr) throw std::runtime_error("the window has no " + name.toStdString());
    return *child;
}

/// Panels arrange themselves, and what they ask for comes.
void settle(MainWindow& window) {
    do {
        QTest::qWait(kRest);
        if (!QTest::qWaitFor([&] { return window.isSettled(); }, kPatience))
            throw std::runtime_error("it does not come to rest");
        QTest::qWait(kRest);
    } while (!window.isSettled());
}

void put(QWidget& control, const QString& value) {
    if (auto* box = qobject_cast<QComboBox*>(&control)) {
        box->setCurrentText(value);
        Q_EMIT box->activated(box->currentIndex());
    } else if (auto* number = qobject_cast<QDoubleSpinBox*>(&control)) {
        number->setValue(value.toDouble());
    } else if (auto* count = qobject_cast<QSpinBox*>(&control)) {
        count->setValue(value.toInt());
    } else if (auto* slider = qobject_cast<QAbstractSlider*>(&control)) {
        slider->setValue(value.toInt());
    } else if (auto* line = qobject_cast<QLineEdit*>(&control)) {
        line->setText(value);
        Q_EMIT line->editingFinished();
    } else {
        throw std::runtime_error("nothing can be set to " + control.objectName().toStdString());
    }
}

struct Output {
    QString file; ///< empty: none
    QWidget* of;
};

void save(const Output& out, QWidget& widget) {
    if (!out.file.isEmpty() && !widget.grab().save(out.file, "PNG"))
        throw std::runtime_error("cannot write " + out.file.toStdString());
}

void take(MainWindow& window, Output& out, const QString& step) {
    const QString kind = step.section(':', 0, 0), name = step.section(':', 1);
    if (kind == step) return found<QAction>(window, step).trigger();
    if (kind == "click") return found<QAbstractButton>(window, name).click();
    if (kind == "set") return put(found<QWidget>(window, name.section('=', 0, 0)), name.section('=', 1));
    if (kind == "select") {
        const auto& features = window.services().scene().tf.features;
        return window.services().selection().setFeature(features.at(static_cast<std::size_t>(name.toInt())).id);
    }
    if (kind == "at") {
        auto& widget = found<QWidget>(window, name.section('=', 0, 0));
        const QStringList place = name.section('=', 1).split(',');
        const QPointF at(place.at(0).toDouble() * widget.width(), place.at(1).toDouble() * widget.height());
        return QTest::mouseClick(&widget, Qt::LeftButton, {}, at.toPoint());
    }
    if (kind == "overlay") {
        VolumeSource source;
        source.path = name.toStdString();
        return window.controllers().overlays.lay(source);
    }
    if (kind == "of") {
        out.of = &found<QWidget>(window, name);
        return;
    }
    if (kind != "dialog") throw std::runtime_error("no such step: " + step.toStdString());
    QTimer::singleShot(500, &window, [&] {
        QWidget* const dialog = QApplication::activeModalWidget();
        if (dialog == nullptr) return;
        save(out, *dialog);
        out.file.clear();
        dialog->close();
    });
    found<QAction>(window, name).trigger();
}

void printAreas(MainWindow& window) {
    const QSize whole = window.size(), picture = window.views().size();
    const auto& canvas = found<TfCanvas>(window, "tfCanvas");
    const auto& bars = found<TargetBars>(window, "targetBars");
    const QSizeF plot = canvas.plot().size();
    const double share = 100.0 * picture.width() * picture.height() / (whole.width() * whole.height());
    std::printf("%4d x %4d   picture %4d x %4d, %4.1f %%   plot %4.0f x %3.0f   bars %3d x %3d of %3d\n", whole.width(),
                whole.height(), picture.width(), picture.height(), share, plot.width(), plot.height(), bars.width(),
                bars.visibleRegion().boundingRect().height(), bars.height());
}

/// Of every panel, as its action shows it in a window that is arranged as at first.
void takePanels(MainWindow& window, const QString& prefix) {
    Camera camera = window.services().scene().camera; // from far away, so that the picture takes no time
    camera.eye = camera.center + 8.0 * (camera.eye - camera.center);
    window.services().store().setCamera(camera);
    for (const PanelInfo& panel : panelRegistry()) {
        window.room().reset();
        settle(window);
        auto& dock = found<QDockWidget>(window, QString(panel.id) + "Dock");
        if (!dock.isVisible() || dock.visibleRegion().isEmpty())
            found<QAction>(window, QString(panel.id) + "Action").trigger();
        settle(window);
        save({prefix + "-" + panel.id + ".png", &window}, window);
        for (const QString& text : cutTexts(dock) + overlaps(dock))
            std::printf("%s: %s\n", panel.id, text.toUtf8().constData());
    }
}

void run(const QCommandLineParser& parser) {
    const QStringList words = parser.positionalArguments();
    if (words.isEmpty()) throw std::runtime_error("name what to open");
    MainWindow window;
    const QStringList size = parser.value("size").split('x');
    window.resize(size.at(0).toInt(), size.at(1).toInt());
    window.show();
    OpenController& opening = window.controllers().opening;
    if (parser.isSet("sample-size")) {
        VolumeSource source;
        source.path = words.front().toStdString();
        source.sampleSize = parser.value("sample-size").toInt();
        opening.openVolume(source);
    } else {
        opening.openAtStart({words.front()}, {});
    }
    settle(window);
    Output out{parser.value("out"), &window};
    for (const QString& step : words.mid(1)) {
        take(window, out, step);
        settle(window);
    }
    if (parser.isSet("panels")) takePanels(window, parser.value("panels"));
    if (parser.isSet("areas")) printAreas(window);
    save(out, *out.of);
}

} // namespace

int main(int argc, char** argv) {
    QApplication application(argc, argv);
    const QTemporaryDir settings; // those of whoever runs it stay theirs
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
    QCoreApplication::setOrganizationName("pellucid-pictures");
    QCommandLineParser parser;
    parser.addPositionalArgument("DOCUMENT", "a volume, a session or sample:NAME");
    parser.addPositionalArgument("STEP", "see the head of window_pictures.cpp", "[STEP…]");
    parser.addOption({"size", "of the window, logical pixels", "WxH", "1280x800"});
    parser.addOption({"sample-size", "voxels along the longest axis of a sample", "N"});
    parser.addOption({"theme", "dark or light", "NAME", "dark"});
    parser.addOption({"areas", "print what picture, plot and bars have of the window"});
    parser.addOption({"panels", "take pictures of all panels, PREFIX-ID.png", "PREFIX"});
    parser.addOption({"out", "where the picture goes", "FILE"});
    parser.addHelpOption();
    parser.process(application);
    applyTheme(application, parser.value("theme") == "light" ? Theme::Light : Theme::Dark);
    try {
        run(parser);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "window_pictures: %s\n", error.what());
        return 1;
    }
}
