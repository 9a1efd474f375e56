// What the tests of the window share.
#pragma once

#include <catch2/catch.hpp>

#include <QAccessible>
#include <QImage>
#include <QSignalSpy>
#include <QTest>

#include "controllers/controllers.h"
#include "panels/features_model.h"
#include "panels/target_bars.h"
#include "store/edits.h"
#include "tf/tf_canvas.h"
#include "volume/procedural.h"
#include "window/main_window.h"

namespace pellucid::gui {

/// Far longer than anything takes, since the machine may be busy; nothing waits longer than it must.
inline constexpr int kPatience = 120000;

template <class Condition>
bool waitFor(Condition condition) {
    return QTest::qWaitFor(condition, kPatience);
}

inline Scene sampleScene(const std::string& name, int size, const TransferFunction& tf) {
    VolumeSource source;
    source.path = "sample:" + name;
    source.sampleSize = size;
    SceneInputs inputs;
    inputs.session = sessionOf(source);
    inputs.session.setTf(tf);
    Scene scene = openScene(inputs);
    prepareToShow(scene);
    return scene;
}

/// What a window shows, in few words: its scene, its history and its figures.
class Document {
public:
    Document(SessionStore& store, Results& results) : m_store(store), m_results(results) {}

    const TransferFunction& tf() const { return m_store.scene().tf; }
    const TransferFunction& committedTf() const { return m_store.committed().tf; }
    const Camera& camera() const { return m_store.scene().camera; }
    const std::shared_ptr<const Volume>& volume() const { return m_store.scene().volume; }
    const Histogram& histogram() const { return *m_store.scene().histogram; }
    std::vector<double> targets() const { return m_store.scene().targets(); }
    const Measures* measures() const { return m_results.measures(); }
    bool measuresAreCurrent() const { return m_results.measuresAreCurrent(); }
    const std::vector<std::vector<double>>* influence() const { return m_results.influence(); }
    const OcclusionMatrix* occlusion() const { return m_results.occlusion(); }
    bool influenceIsCurrent() const { return m_results.influenceIsCurrent(); }
    bool isPreviewing() const { return m_store.isPreviewing(); }
    bool isClean() const { return m_store.isClean(); }

    /// As a file without a range is opened: written for the window.
    void setTf(TransferFunction tf, const QString& text, const QString& mergeKey = {}) {
        tf.range = volume()->range();
        editTf(m_store, tf, text, mergeKey);
    }
    void setTargets(const std::vector<double>& targets) { editTargets(m_store, targets, "Targets"); }
    void setTarget(int feature, double value) { editTarget(m_store, feature, value, "Target"); }
    void setCamera(const Camera& camera) { m_store.setCamera(camera); }
    void previewTf(TransferFunction tf) {
        tf.range = volume()->range();
        gui::previewTf(m_store, tf, "Preview");
    }
    void undo() { m_store.undo(); }
    void redo() { m_store.redo(); }
    bool canUndo() const { return m_store.canUndo(); }
    int stepCount() const { return m_store.stepCount(); }
    SessionStore& store() { return m_store; }

private:
    SessionStore& m_store;
    Results& m_results;
};

/// The points and features alone, without the range that a window puts to them.
inline TransferFunction rangeless(TransferFunction tf) {
    tf.range.reset();
    return tf;
}

/// A store and its figures, without a window.
struct StoreAlone {
    SessionStore store;
    Workspace workspace;
    Lane lane;
    Results results{store, lane, workspace};
    Document document{store, results};
    Document* operator->() { return &document; }
};

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
        opening().openVolume(source, "tents:3");
        settle();
    }
    /// Returns when it is open, which is before all is drawn and measured.
    void open(const VolumeSource& source) {
        QSignalSpy opened(&opening(), &OpenController::opened);
        opening().openVolume(source);
        REQUIRE(waitFor([&] { return opened.count() == 1; }));
    }
    void settle() {
        REQUIRE(waitFor([this] { return window.isSettled(); }));
    }
    Services& services() { return window.services(); }
    Controllers& controllers() { return window.controllers(); }
    OpenController& opening() { return controllers().opening; }
    SaveController& saving() { return controllers().saving; }
    OptimizeController& optimizing() { return controllers().optimizing; }
    RefineController& refining() { return controllers().refining; }
    Document document() { return {services().store(), services().results()}; }
    VolumeView& view() { return window.view(); }
    TfCanvas& canvas() { return child<TfCanvas>("tfCanvas"); }
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

/// What a screen reader hears of what a widget shows.
inline QString heardValue(QWidget& widget) {
    QAccessibleInterface* const spoken = QAccessible::queryAccessibleInterface(&widget);
    return spoken == nullptr ? QString() : spoken->text(QAccessible::Value);
}

/// Between channels of pixels, of 255.
inline int largestDifference(const QImage& a, const QImage& b) {
    REQUIRE(a.size() == b.size());
    int largest = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            for (const int d : {qRed(p) - qRed(q), qGreen(p) - qGreen(q), qBlue(p) - qBlue(q)})
                largest = std::max(largest, std::abs(d));
        }
    return largest;
}

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
