// Pictures of the window in any state, and how its room is shared out; for the guide, and for people who change how the
// window looks.
//
//     window_pictures [--size WxH] [--theme NAME] [--sample-size N] [--frames A:B[:STEP]] [--tf SPEC] [--areas]
//     [--out FILE.png] [--panels PREFIX] DOCUMENT [STEP…]
//
// DOCUMENT is opened as the window opens it: a volume, a session, or a picture that carries one. A STEP is the name of
// an action, which is triggered, or one of
//     click:NAME          a press on a button
//     set:NAME=VALUE      a number, a choice or a text into a control
//     key:NAME=KEY        a key on a widget, such as L or Ctrl+A
//     at:NAME=X,Y         a click on a widget, X and Y in parts of its width and height
//     over:NAME=X,Y       the mouse rests on it
//     drag:NAME=X,Y,X,Y   the left button from the one place to the other
//     wheel:NAME=X,Y,N    N notches, away from the hand where N is positive
//     height:ID=N         of a panel at the bottom, logical pixels
//     select:N            feature N, from 0
//     targets:N,N,…       of the features, in proportion
//     view:VIEW           as pellucid-cli --view has it
//     frame:N             of the series, from 0
//     crosshair:X,Y,Z     of the slices, in the world
//     overlay:FILE        a second volume over the first
//     open:FILE           another document
//     of:NAME             the picture is of this widget alone
//     dialog:STEP         last: the step opens a dialog, of which the picture is
// Each step is waited for: jobs, the picture, and whatever shows a progress bar. --panels takes a picture of the window
// with each panel opened by its action, PREFIX-ID.png, and prints texts that are cut off; the camera is far away, so
// that this takes no long time. --areas prints what picture, plot and bars have of the window, in logical pixels.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
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
#include <QMouseEvent>
#include <QProgressBar>
#include <QSettings>
#include <QSlider>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>
#include <QWheelEvent>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/target_bars.h"
#include "render/view_text.h"
#include "session/target_presets.h"
#include "store/edits.h"
#include "support/cut_texts.h"
#include "tf/tf_canvas.h"
#include "widgets/theme.h"
#include "window/main_window.h"
#include "window/room.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kPatience = 600000, kRest = 150; // milliseconds
constexpr int kDialogRest = 1500;              // in which a dialog that is ready does not change

template <class T>
T& found(MainWindow& window, const QString& name) {
    T* const child = window.findChild<T*>(name);
    if (child == nullptr) throw std::runtime_error("the window has no " + name.toStdString());
    return *child;
}

/// What shows a progress bar, such as the best view, is done, too.
bool isDone(const MainWindow& window) {
    const auto bars = window.findChildren<QProgressBar*>();
    return window.isSettled() && !window.findChild<TfCanvas*>()->isCounting() &&
           std::none_of(bars.begin(), bars.end(), [](const QProgressBar* bar) { return bar->isVisible(); });
}

/// Panels arrange themselves, and what they ask for comes.
template <class Condition>
void settle(const Condition& isSettled) {
    do {
        QTest::qWait(kRest);
        if (!QTest::qWaitFor(isSettled, kPatience)) throw std::runtime_error("it does not come to rest");
        QTest::qWait(kRest);
    } while (!isSettled());
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

/// "NAME=WORDS".
template <class T = QWidget>
std::pair<T&, QString> addressed(MainWindow& window, const QString& words) {
    return {found<T>(window, words.section('=', 0, 0)), words.section('=', 1)};
}

std::vector<double> numbersOf(const QString& text, std::size_t least = 1) {
    std::vector<double> numbers;
    for (const QString& word : text.split(',')) numbers.push_back(word.toDouble());
    if (numbers.size() < least) throw std::runtime_error("too few numbers: " + text.toStdString());
    return numbers;
}

/// X and Y in parts of the width and height.
QPointF placeIn(const QWidget& widget, double x, double y) { return {x * widget.width(), y * widget.height()}; }

void sendMouse(QWidget& widget, QEvent::Type type, const QPointF& at, Qt::MouseButton changed, Qt::MouseButtons held) {
    QMouseEvent event(type, at, widget.mapToGlobal(at), changed, held, {});
    QCoreApplication::sendEvent(&widget, &event);
    QCoreApplication::processEvents();
}

void drag(QWidget& widget, const QPointF& from, const QPointF& to) {
    constexpr int kSteps = 6;
    sendMouse(widget, QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
    for (int i = 1; i <= kSteps; ++i)
        sendMouse(widget, QEvent::MouseMove, from + (to - from) * i / kSteps, Qt::NoButton, Qt::LeftButton);
    sendMouse(widget, QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
}

void pressKey(QWidget& widget, const QString& keys) {
    const QKeySequence sequence(keys);
    if (sequence.isEmpty()) throw std::runtime_error("no such key: " + keys.toStdString());
    widget.setFocus();
    QTest::keyClick(&widget, sequence[0].key(), sequence[0].keyboardModifiers());
}

void roll(QWidget& widget, const QPointF& at, int notches) {
    constexpr int kNotch = 120; // Qt's unit
    QWheelEvent event(at, widget.mapToGlobal(at), {}, {0, kNotch * notches}, Qt::NoButton, {}, Qt::NoScrollPhase,
                      false);
    QCoreApplication::sendEvent(&widget, &event);
}

void lookFrom(MainWindow& window, const std::string& words) {
    const Scene& scene = window.services().scene();
    const Geometry& geometry = scene.volume->geometry();
    const WordedView view = viewFromText(words);
    const auto* const name = std::get_if<NamedView>(&view);
    const ViewAngles angles = name != nullptr ? anglesOf(*name, geometry.worldAxes) : std::get<ViewAngles>(view);
    window.services().store().setCamera(
        cameraFromView(geometry, angles.azimuth, angles.elevation, angles.zoom, scene.camera.projection));
}

void wantTargets(MainWindow& window, const std::vector<double>& weights) {
    const Scene& scene = window.services().scene();
    if (weights.size() != scene.tf.features.size()) throw std::runtime_error("one target per feature is wanted");
    editTargets(window.services().store(), targetsByWeights(scene.wantedTf(), *scene.session.goals, weights),
                "Targets");
}

void take(MainWindow& window, Output& out, const QString& step);

/// Of the dialog that a step opens, once it changes no more.
void takeDialog(MainWindow& window, Output& out, const QString& step) {
    QTimer timer;
    QImage last;
    bool taken = false;
    QObject::connect(&timer, &QTimer::timeout, &window, [&] {
        QWidget* const dialog = QApplication::activeModalWidget();
        if (dialog == nullptr || taken) return;
        const QImage now = dialog->grab().toImage();
        if (now != std::exchange(last, now)) return;
        save(out, *dialog);
        taken = true;
        dialog->close();
    });
    timer.start(kDialogRest);
    take(window, out, step);
    if (!QTest::qWaitFor([&] { return taken; }, kPatience)) throw std::runtime_error("no dialog comes to rest");
    out.file.clear();
}

using Step = std::function<void(MainWindow&, Output&, const QString&)>;

const std::map<QString, Step>& steps() {
    static const std::map<QString, Step> all{
        {"click", [](MainWindow& w, Output&, const QString& name) { found<QAbstractButton>(w, name).click(); }},
        {"set",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [control, value] = addressed(w, words);
             put(control, value);
         }},
        {"key",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [widget, keys] = addressed(w, words);
             pressKey(widget, keys);
         }},
        {"at",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [widget, text] = addressed(w, words);
             const auto at = numbersOf(text, 2);
             QTest::mouseClick(&widget, Qt::LeftButton, {}, placeIn(widget, at[0], at[1]).toPoint());
         }},
        {"over",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [widget, text] = addressed(w, words);
             const auto at = numbersOf(text, 2);
             sendMouse(widget, QEvent::MouseMove, placeIn(widget, at[0], at[1]), Qt::NoButton, Qt::NoButton);
         }},
        {"drag",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [widget, text] = addressed(w, words);
             const auto at = numbersOf(text, 4);
             drag(widget, placeIn(widget, at[0], at[1]), placeIn(widget, at[2], at[3]));
         }},
        {"wheel",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [widget, text] = addressed(w, words);
             const auto at = numbersOf(text, 3);
             roll(widget, placeIn(widget, at[0], at[1]), static_cast<int>(at[2]));
         }},
        {"height",
         [](MainWindow& w, Output&, const QString& words) {
             const auto [dock, pixels] =
                 addressed<QDockWidget>(w, words.section('=', 0, 0) + "Dock=" + words.section('=', 1));
             w.resizeDocks({&dock}, {pixels.toInt()}, Qt::Vertical);
         }},
        {"select",
         [](MainWindow& w, Output&, const QString& n) {
             const auto& features = w.services().scene().tf.features;
             w.services().selection().setFeature(features.at(static_cast<std::size_t>(n.toInt())).id);
         }},
        {"targets", [](MainWindow& w, Output&, const QString& text) { wantTargets(w, numbersOf(text)); }},
        {"view", [](MainWindow& w, Output&, const QString& view) { lookFrom(w, view.toStdString()); }},
        {"frame", [](MainWindow& w, Output&, const QString& n) { w.controllers().player.goTo(n.toInt()); }},
        {"crosshair",
         [](MainWindow& w, Output&, const QString& text) {
             const auto at = numbersOf(text, 3);
             const Geometry& geometry = w.services().scene().volume->geometry();
             w.services().store().setCrosshair(geometry.voxelFromWorld({at[0], at[1], at[2]}));
         }},
        {"overlay",
         [](MainWindow& w, Output&, const QString& file) {
             VolumeSource source;
             source.path = file.toStdString();
             w.controllers().overlays.lay(source);
         }},
        {"open", [](MainWindow& w, Output&, const QString& file) { w.controllers().opening.openPath(file); }},
        {"of", [](MainWindow& w, Output& out, const QString& name) { out.of = &found<QWidget>(w, name); }},
        {"dialog", takeDialog},
    };
    return all;
}

void take(MainWindow& window, Output& out, const QString& step) {
    const QString kind = step.section(':', 0, 0);
    if (kind == step) return found<QAction>(window, step).trigger();
    const auto known = steps().find(kind);
    if (known == steps().end()) throw std::runtime_error("no such step: " + step.toStdString());
    known->second(window, out, step.section(':', 1));
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
    const auto atRest = [&] { return window.isSettled(); }; // how far panels are is no matter
    for (const PanelInfo& panel : panelRegistry()) {
        window.room().reset();
        settle(atRest);
        auto& dock = found<QDockWidget>(window, QString(panel.id) + "Dock");
        if (!dock.isVisible() || dock.visibleRegion().isEmpty())
            found<QAction>(window, QString(panel.id) + "Action").trigger();
        settle(atRest);
        save({prefix + "-" + panel.id + ".png", &window}, window);
        for (const QString& text : cutTexts(dock) + overlaps(dock) + scrolledSideways(dock))
            std::printf("%s: %s\n", panel.id, text.toUtf8().constData());
    }
}

void openFirst(MainWindow& window, const QString& document, const QCommandLineParser& parser) {
    OpenController& opening = window.controllers().opening;
    const QString tf = parser.value("tf");
    if (!parser.isSet("sample-size") && !parser.isSet("frames")) return opening.openAtStart({document}, tf);
    VolumeSource source;
    source.path = document.toStdString();
    source.sampleSize = parser.value("sample-size").toInt();
    if (const QStringList frames = parser.value("frames").split(':'); frames.size() > 1)
        source.frames = FrameRange{frames.at(0).toInt(), frames.at(1).toInt(), frames.value(2, "1").toInt()};
    opening.openVolume(source, tf);
}

void run(const QCommandLineParser& parser) {
    const QStringList words = parser.positionalArguments();
    if (words.isEmpty()) throw std::runtime_error("name what to open");
    MainWindow window;
    const QStringList size = parser.value("size").split('x');
    window.resize(size.at(0).toInt(), size.at(1).toInt());
    window.show();
    const auto isReady = [&] { return isDone(window); };
    openFirst(window, words.front(), parser);
    settle(isReady);
    Output out{parser.value("out"), &window};
    for (const QString& step : words.mid(1)) {
        take(window, out, step);
        settle(isReady);
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
    parser.addOption({"frames", "only these of a series, from 0, B included", "A:B[:STEP]"});
    parser.addOption({"tf", "what the volume opens with, as pellucid --tf has it", "SPEC"});
    parser.addOption({"theme", "dark or light", "NAME", "dark"});
    parser.addOption({"areas", "print what picture, plot and bars have of the window"});
    parser.addOption({"panels", "take pictures of all panels, PREFIX-ID.png", "PREFIX"});
    parser.addOption({"out", "where the picture goes", "FILE"});
    parser.addHelpOption();
    parser.process(application);
    QApplication::setCursorFlashTime(0);
    applyTheme(application, parser.value("theme") == "light" ? Theme::Light : Theme::Dark);
    try {
        run(parser);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "window_pictures: %s\n", error.what());
        return 1;
    }
}
