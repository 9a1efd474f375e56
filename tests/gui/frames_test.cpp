// How long a frame takes while the hand turns the volume, and what rests afterwards; run by hand:
//   PELLUCID_VOLUME=scan.nrrd xvfb-run -a -s "-screen 0 1600x1000x24" build/release/bin/test_gui "[.frames]"
#include "gui_support.h"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include <QElapsedTimer>
#include <QEventLoop>
#include <QTimer>

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kFrames = 80;

template <class T>
T quantile(std::vector<T> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size()))];
}

} // namespace

TEST_CASE("frames of a rotation", "[.frames]") {
    if (qEnvironmentVariableIsEmpty("PELLUCID_VOLUME")) return;
    SceneInputs inputs;
    VolumeSource source;
    source.path = qEnvironmentVariable("PELLUCID_VOLUME").toStdString();
    inputs.session = sessionOf(source);
    inputs.tf = qEnvironmentVariable("PELLUCID_TF", "tents:3").toStdString();
    inputs.session.display.edit([](DisplaySettings& d) { d.light.on = true; });
    Scene scene = openScene(inputs);
    prepareToShow(scene);
    SessionStore store;
    VolumeView view(store, ViewRenderer::Cpu);
    view.resize(1600, 970);
    view.show();
    REQUIRE(QTest::qWaitForWindowExposed(&view, kPatience));
    store.open(scene);
    REQUIRE(waitFor([&] { return view.isComplete(); }));

    const auto send = [&](QEvent::Type type, const QPointF& at, Qt::MouseButtons held) {
        QMouseEvent event(type, at, view.mapToGlobal(at), type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton,
                          held, Qt::NoModifier);
        QCoreApplication::sendEvent(&view, &event);
    };
    std::vector<double> milliseconds, scales;
    QEventLoop loop; // ends with the picture: qWaitFor() looks every 10 ms
    bool hasCome = false;
    QObject::connect(&view, &VolumeView::pictureShown, &loop, [&] {
        hasCome = true;
        loop.quit();
    });
    QTimer patience;
    QObject::connect(&patience, &QTimer::timeout, &loop, &QEventLoop::quit);
    patience.start(kPatience);
    send(QEvent::MouseButtonPress, {600, 480}, Qt::LeftButton);
    for (int i = 1; i <= kFrames; ++i) {
        QElapsedTimer timer;
        timer.start();
        hasCome = false;
        send(QEvent::MouseMove, {600.0 + 5 * i, 480.0 + i}, Qt::LeftButton);
        if (!hasCome) loop.exec();
        REQUIRE(hasCome);
        QCoreApplication::processEvents(); // it is painted
        milliseconds.push_back(1e-6 * static_cast<double>(timer.nsecsElapsed()));
        scales.push_back(view.picture().resolutionScale);
    }
    QElapsedTimer rest;
    rest.start();
    send(QEvent::MouseButtonRelease, {1000, 560}, Qt::NoButton);
    REQUIRE(waitFor([&] { return view.isComplete(); }));
    const qint64 complete = rest.elapsed();
    QTest::qWait(500);
    const std::clock_t start = std::clock();
    QTest::qWait(3000);
    const double idle = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf(
        "frame: median %.1f ms, 90%% %.1f ms; resolution: median %.2f, least %.2f; complete after %lld ms; idle: "
        "%.3f s of processor time in 3 s\n",
        quantile(milliseconds, 0.5), quantile(milliseconds, 0.9), quantile(scales, 0.5), quantile(scales, 0.0),
        complete, idle);
}
