// What the tests of the window share.
#pragma once

#include <catch2/catch.hpp>

#include <QImage>
#include <QTest>

#include "main_window.h"
#include "volume/procedural.h"

namespace pellucid::gui {

/// Far longer than anything takes, since the machine may be busy; nothing waits longer than it must.
inline constexpr int kPatience = 120000;

template <class Condition>
bool waitFor(Condition condition) {
    return QTest::qWaitFor(condition, kPatience);
}

inline LoadedVolume loadedSample(const std::string& name, int size, const TransferFunction& tf) {
    LoadedVolume loaded;
    loaded.source.path = "sample:" + name;
    loaded.source.sampleSize = size;
    loaded.volume = std::make_shared<const Volume>(makeSample(name, size));
    loaded.histogram = makeHistogram(*loaded.volume);
    loaded.defaultTf = tf;
    return loaded;
}

/// A window on a small sample, complete with picture and figures.
struct OpenWindow {
    MainWindow window;

    explicit OpenWindow(int size = 24, ViewRenderer renderer = ViewRenderer::Auto) : window(renderer) {
        window.resize(1100, 720);
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window, kPatience));
        VolumeSource source;
        source.path = "sample:shells";
        source.sampleSize = size;
        window.openVolume(source, "tents:3");
        settle();
    }
    void settle() {
        REQUIRE(waitFor([this] { return window.isSettled(); }));
    }
    Document& document() { return window.document(); }
    VolumeView& view() { return window.view(); }
    TfCanvas& canvas() { return window.tfEditor().canvas(); }
    QImage picture() {
        settle();
        return view().grab().toImage().convertToFormat(QImage::Format_RGB32);
    }
    template <class T>
    T& child(const char* name) {
        T* found = window.findChild<T*>(name);
        REQUIRE(found != nullptr);
        return *found;
    }
};

/// Press, moves and release, as a hand would.
inline void drag(QWidget& widget, const QPointF& from, const QPointF& to, Qt::MouseButton button = Qt::LeftButton,
                 Qt::KeyboardModifiers modifiers = {}) {
    const auto send = [&](QEvent::Type type, const QPointF& at, Qt::MouseButton changed, Qt::MouseButtons held) {
        QMouseEvent event(type, at, widget.mapToGlobal(at), changed, held, modifiers);
        QCoreApplication::sendEvent(&widget, &event);
    };
    send(QEvent::MouseButtonPress, from, button, button);
    constexpr int kSteps = 6;
    for (int i = 1; i <= kSteps; ++i) {
        send(QEvent::MouseMove, from + (to - from) * i / kSteps, Qt::NoButton, button);
        QCoreApplication::processEvents();
    }
    send(QEvent::MouseButtonRelease, to, button, Qt::NoButton);
}

} // namespace pellucid::gui
