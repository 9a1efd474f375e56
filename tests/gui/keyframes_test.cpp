// The panel of keyframes: keys of what is shown, the playhead, the strip under the mouse and by keys, files and films.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QSpinBox>
#include <QStandardItemModel>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolButton>

#include "dialogs/film_dialog.h"
#include "engines/engines.h"
#include "panels/key_strip.h"
#include "render/camera_motion.h"
#include "session/keyframes_file.h"
#include "session/session_json.h"
#include "tf/tf_range.h"
#include "widgets/image_convert.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct OpenKeyframes : OpenWindow {
    explicit OpenKeyframes(int size = 16) : OpenWindow(size) {
        window.resize(1280, 800);
        services().panels().show("keyframes");
        window.activateWindow(); // keys go to the active window alone
        REQUIRE(waitFor([&] { return window.isActiveWindow(); }));
        settle();
    }
    KeyframesController& keyframes() { return controllers().keyframes; }
    const Keyframes& keys() { return keyframes().keys(); }
    KeyStrip& strip() { return child<KeyStrip>("keyStrip"); }
    SessionStore& store() { return services().store(); }
    Camera viewFrom(double azimuth) {
        return cameraFromView(document().volume()->geometry(), azimuth, 15, 1, Projection::Perspective);
    }
    void look(double azimuth) { store().setCamera(viewFrom(azimuth)); }
    void fade(double opacity) {
        TransferFunction tf = document().tf();
        tf.points[1].opacity = opacity;
        document().setTf(tf, "Fade");
    }
    void click(const char* name) {
        auto& button = child<QToolButton>(name);
        REQUIRE(button.isVisible());
        REQUIRE(button.isEnabled());
        QTest::mouseClick(&button, Qt::LeftButton);
    }
    /// From three sides, at 0, 2 and 4 s; the second one is fainter, the third one without light.
    void addThree() {
        look(10);
        click("keyframesAdd");
        look(100);
        fade(0.05);
        click("keyframesAdd");
        look(200);
        editPart(store(), &Session::display, "Light", {}, [](DisplaySettings& d) { d.light.on = false; });
        click("keyframesAdd");
        REQUIRE(keys().size() == 3);
    }
    KeyState shown() { return keyStateOf(services().scene()); }
    /// What is shown is what the film has at the time, as far as keys decide it.
    void checkShows(double time) {
        const KeyState wanted = stateAt(keys(), time, document().volume()->geometry());
        CHECK(shown().camera == wanted.camera);
        CHECK(rangeless(shown().tf) == rangeless(inRange(wanted.tf, document().volume()->range())));
        CHECK(shown().clipping == wanted.clipping);
        CHECK(shown().light == wanted.light);
    }
    QPointF onScale(double time) { return {strip().xOf(time), 5}; }
    QPointF onKey(int key) { return strip().places()[static_cast<std::size_t>(key)].rect.center(); }
    bool hasAllPictures() {
        const auto& places = strip().places();
        return !places.empty() && std::ranges::none_of(places, [](const auto& p) { return p.picture.isNull(); });
    }
    bool hasNotice(const QString& part) {
        return std::ranges::any_of(services().notices().all(),
                                   [&](const Notice& notice) { return notice.text.contains(part); });
    }
};

/// Answers the film dialog once it is open.
void withFilmDialog(const std::function<void(FilmDialog&)>& answer) {
    QTimer::singleShot(0, [answer] {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (auto* dialog = qobject_cast<FilmDialog*>(widget); dialog != nullptr && dialog->isVisible())
                return answer(*dialog);
        FAIL("no film dialog");
    });
}

/// Presses a button of the question that comes up next, and keeps what was asked.
struct Press {
    explicit Press(const QString& button) {
        m_timer.start(20);
        m_timer.callOnTimeout([this, button] {
            auto* const box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
            if (box == nullptr) return;
            m_timer.stop();
            asked = box->text();
            for (QAbstractButton* one : box->buttons())
                if (one->text().remove('&') == button) return QTest::mouseClick(one, Qt::LeftButton);
            box->reject();
            FAIL("no such button: " << button.toStdString());
        });
    }
    QString asked;

private:
    QTimer m_timer;
};

QByteArray bytesOf(const QString& path) {
    QFile file(path);
    REQUIRE(file.open(QIODevice::ReadOnly));
    return file.readAll();
}

} // namespace

TEST_CASE("keys keep what is shown, and the playhead shows what lies between them", "[keyframes]") {
    OpenKeyframes w;
    CHECK(w.keyframes().selected() == -1);
    CHECK_FALSE(w.child<QToolButton>("keyframesReplace").isEnabled());
    CHECK_FALSE(w.child<QLineEdit>("keyframesName").isEnabled());
    CHECK(w.document().isClean());
    w.addThree();
    CHECK_FALSE(w.document().isClean());
    CHECK(w.document().stepCount() == 5); // three keys, a fading and a light
    CHECK(w.keys()[1].time == 2);
    CHECK(w.keys()[2].time == 4);
    CHECK(w.keys()[0].state.camera == w.viewFrom(10));
    CHECK(w.keys()[1].state.tf.points[1].opacity == 0.05);
    CHECK((!w.keys()[2].state.light.on && w.keys()[1].state.light.on));
    CHECK(w.child<QComboBox>("keyframesKey").currentText() == "Key 3 at 4 s");
    CHECK(w.child<QLabel>("keyframesTime").text() == "4.00 s of 4.00 s");

    // Between the keys, by a drag that one sees.
    const KeyState third = w.shown();
    const QPointF from = w.onScale(4), to = w.onScale(1);
    QTest::mousePress(&w.strip(), Qt::LeftButton, {}, from.toPoint());
    QTest::mouseMove(&w.strip(), to.toPoint());
    REQUIRE(waitFor([&] { return w.document().isPreviewing(); }));
    REQUIRE(waitFor([&] { return std::abs(w.keyframes().playhead() - 1) < 0.05; }));
    w.checkShows(w.keyframes().playhead());
    CHECK_FALSE(w.shown() == third);
    // Given up, it was nothing.
    QTest::keyClick(&w.strip(), Qt::Key_Escape);
    QTest::mouseRelease(&w.strip(), Qt::LeftButton, {}, to.toPoint());
    CHECK(w.shown() == third);
    CHECK(w.keyframes().playhead() == 4);
    CHECK(w.document().stepCount() == 5);

    // At rest it is one step.
    drag(w.strip(), from, to);
    CHECK_FALSE(w.document().isPreviewing());
    CHECK(w.keyframes().playhead() == Approx(1).margin(0.05));
    w.checkShows(w.keyframes().playhead());
    CHECK(w.document().stepCount() == 6);
    drag(w.strip(), w.onScale(1), w.onScale(3)); // many moves in a row are one
    w.checkShows(w.keyframes().playhead());
    CHECK(w.document().stepCount() == 6);
    w.document().undo();
    CHECK(w.shown().tf == third.tf);
    CHECK(w.shown().light == third.light);
    CHECK(w.keys().size() == 3);
    w.store().undoCamera();
    w.store().undoCamera();
    CHECK(w.shown() == third);

    // Keys are undone like all else.
    w.document().undo();
    CHECK(w.keys().size() == 2);
    CHECK(w.keyframes().selected() == 1);
    w.document().redo();
    CHECK(w.keys().size() == 3);
    CHECK(w.keys()[2].state == third);
}

TEST_CASE("the playhead covers no label of the scale", "[keyframes]") {
    OpenKeyframes w;
    w.addThree();
    REQUIRE(waitFor([&] { return w.hasAllPictures(); }));
    const auto labels = [&](double time) {
        w.strip().setPlayhead(time);
        return w.strip().grab().toImage().copy(2, 2, w.strip().width() - 4, 12);
    };
    CHECK(labels(0) == labels(2)); // 0 s and 2 s have one
    CHECK(labels(1.3) == labels(2));
}

TEST_CASE("the strip has a picture of each key, and of what lies between", "[keyframes]") {
    OpenKeyframes w;
    w.addThree();
    REQUIRE(waitFor([&] { return w.hasAllPictures(); }));
    const auto places = w.strip().places();
    REQUIRE(places.size() > 3);
    CHECK(places[3].key == -1);
    CHECK((places[3].time > 0 && places[3].time < 2));
    for (int n = 0; n < 3; ++n) CHECK(places[static_cast<std::size_t>(n)].key == n);
    CHECK(places[0].picture != places[1].picture);
    // As the picture of that moment is drawn elsewhere.
    const auto drawn = [&](const KeyStrip::Slot& place) {
        const Scene& scene = w.services().scene();
        const KeyState state = stateAt(w.keys(), place.time, scene.volume->geometry());
        PictureInput input = pictureInput(withKeyState(scene, state), place.picture.width(), place.picture.height());
        input.settings.stepInD0 = 1;
        input.settings.finestInD0.reset();
        return qImageFromImage(makeCpuRenderer(input.volume)->render(input.camera, input.tf, input.settings, {}));
    };
    for (const auto& place : places) {
        INFO(place.time);
        CHECK(largestDifference(place.picture.convertToFormat(QImage::Format_RGB32),
                                drawn(place).convertToFormat(QImage::Format_RGB32)) <= 1);
    }
    // A key that changes gets another picture; the other keys keep theirs, and so does one that moves.
    w.keyframes().select(0);
    w.look(300);
    w.click("keyframesReplace");
    CHECK(w.strip().places()[1].picture == places[1].picture);
    REQUIRE(waitFor([&] { return w.hasAllPictures(); }));
    CHECK(w.strip().places()[0].picture != places[0].picture);
    w.child<QDoubleSpinBox>("keyframesAt").setValue(0.5);
    CHECK(w.keys()[0].time == 0.5);
    CHECK_FALSE(w.strip().places()[0].picture.isNull());
    // Another background is another picture of all.
    REQUIRE(waitFor([&] { return w.hasAllPictures(); }));
    const QImage dark = w.strip().places()[2].picture;
    editPart(w.store(), &Session::display, "Background", {}, [](DisplaySettings& d) { d.background = {1, 1, 1}; });
    REQUIRE(waitFor([&] { return w.hasAllPictures(); }));
    CHECK(w.strip().places()[2].picture != dark);
}

TEST_CASE("keys are changed by controls and by the mouse, step by step", "[keyframes]") {
    OpenKeyframes w;
    w.addThree();
    const KeyState second = w.keys()[1].state;
    QTest::mouseClick(&w.strip(), Qt::LeftButton, {}, w.onKey(1).toPoint());
    CHECK(w.keyframes().selected() == 1);
    w.checkShows(2);
    CHECK(w.shown().camera == second.camera);
    const int steps = w.document().stepCount();

    auto& name = w.child<QLineEdit>("keyframesName");
    name.setFocus();
    QTest::keyClicks(&name, "faint");
    QTest::keyClick(&name, Qt::Key_Return);
    CHECK(w.keys()[1].name == "faint");
    auto& easing = w.child<QComboBox>("keyframesEasing");
    easing.setFocus();
    QTest::keyClick(&easing, Qt::Key_Down);
    CHECK(w.keys()[1].easing == Easing::Smooth);
    CHECK(easing.currentText() == "from rest to rest");
    CHECK(w.document().stepCount() == steps + 2);
    CHECK(w.child<QComboBox>("keyframesKey").currentText() == "Key 2 at 2 s: faint");

    // Behind the third one, by a drag: the order follows.
    const double by = w.strip().xOf(2.5) - w.strip().xOf(0);
    drag(w.strip(), w.onKey(1), w.onKey(1) + QPointF(by, 0));
    CHECK(w.keys()[2].name == "faint");
    CHECK(w.keys()[2].time == Approx(4.5).margin(0.05));
    CHECK(w.keys()[2].state == second);
    CHECK(w.keyframes().selected() == 2);
    CHECK_FALSE(w.child<QComboBox>("keyframesEasing").isEnabled()); // there is no next one
    CHECK(w.document().stepCount() == steps + 3);
    w.document().undo();
    CHECK(w.keys()[1].name == "faint");
    CHECK(w.keys()[1].time == 2);

    // Onto another one it comes after it: none is lost.
    w.keyframes().select(1);
    w.child<QDoubleSpinBox>("keyframesAt").setValue(4);
    REQUIRE(w.keys().size() == 3);
    CHECK(w.keys()[2].name == "faint");
    CHECK(w.keys()[2].time == Approx(4.01));
    w.click("keyframesRemove");
    CHECK(w.keys().size() == 2);
    w.document().undo();
    CHECK(w.keys().size() == 3);
}

TEST_CASE("keyframes are worked with by the keyboard alone", "[keyframes]") {
    OpenKeyframes w;
    w.addThree();
    KeyStrip& strip = w.strip();
    strip.setFocus();
    const auto press = [&](Qt::Key key, Qt::KeyboardModifiers with = {}) { QTest::keyClick(&strip, key, with); };
    press(Qt::Key_Home);
    CHECK(w.keyframes().selected() == 0);
    w.checkShows(0);
    press(Qt::Key_Right);
    press(Qt::Key_Right, Qt::ShiftModifier);
    CHECK(w.keyframes().playhead() == Approx(1.1));
    w.checkShows(w.keyframes().playhead());
    press(Qt::Key_Insert); // what lies between becomes a key
    REQUIRE(w.keys().size() == 4);
    CHECK(w.keys()[1].time == Approx(1.1));
    CHECK(w.keyframes().selected() == 1);
    press(Qt::Key_Right, Qt::ControlModifier);
    CHECK(w.keys()[1].time == Approx(1.2));
    CHECK(w.keyframes().playhead() == Approx(1.2));
    press(Qt::Key_PageDown);
    CHECK(w.keyframes().selected() == 2);
    press(Qt::Key_PageUp);
    press(Qt::Key_Delete);
    CHECK(w.keys().size() == 3);
    press(Qt::Key_End);
    CHECK(w.keyframes().selected() == 2);
    // Where a key is already, another one comes after the last.
    press(Qt::Key_Insert);
    CHECK(w.keys().size() == 4);
    CHECK(w.keys()[3].time == 6);
}

TEST_CASE("keyframes play in real time, and Esc puts back what was shown", "[keyframes]") {
    OpenKeyframes w;
    w.addThree();
    const KeyState before = w.shown();
    w.strip().setFocus();
    QTest::keyClick(&w.strip(), Qt::Key_Space); // at the end: from the first key
    CHECK(w.keyframes().isPlaying());
    CHECK(w.child<QToolButton>("keyframesPlay").text() == "Pause");
    REQUIRE(waitFor([&] { return w.keyframes().playhead() > 0.2; }));
    CHECK_FALSE(w.shown() == before);
    QTest::keyClick(&w.strip(), Qt::Key_Escape);
    CHECK_FALSE(w.keyframes().isPlaying());
    CHECK(w.shown() == before);
    CHECK(w.document().stepCount() == 5);

    w.keyframes().goTo(3.7);
    QElapsedTimer clock;
    clock.start();
    w.click("keyframesPlay");
    REQUIRE(waitFor([&] { return !w.keyframes().isPlaying(); }));
    CHECK(clock.elapsed() >= 290);
    CHECK(w.keyframes().playhead() == 4);
    w.checkShows(4);
    CHECK(w.document().stepCount() <= 6);
}

TEST_CASE("keyframes are saved to a file and opened again, and a session has them", "[keyframes]") {
    const QTemporaryDir folder;
    OpenKeyframes w;
    w.addThree();
    w.keyframes().rename("end");
    const Keyframes keys = w.keys();
    w.keyframes().save(folder.filePath("a.film.json"));
    CHECK(readKeyframes(folder.filePath("a.film.json").toStdString(), w.services().scene()) == keys);
    while (!w.keys().empty()) w.keyframes().remove();
    const int steps = w.document().stepCount();
    w.keyframes().open(folder.filePath("a.film.json"));
    CHECK(w.keys() == keys);
    CHECK(w.document().stepCount() == steps + 1);
    // Whatever numbers the features of another session have, they are known here by their names.
    for (const Feature& f : w.keys()[0].state.tf.features) CHECK(f.id == 0);
    const std::vector<Feature> known = w.document().tf().features;
    w.keyframes().select(0);
    REQUIRE(w.document().tf().features.size() == known.size());
    for (std::size_t n = 0; n < known.size(); ++n) CHECK(w.document().tf().features[n].id == known[n].id);

    const std::string session = folder.filePath("a.pellucid.json").toStdString();
    writeSession(w.store().session(), session);
    CHECK(*readSession(session).session.keyframes == keys);

    QFile broken(folder.filePath("b.film.json"));
    REQUIRE(broken.open(QIODevice::WriteOnly));
    broken.write("{}");
    broken.close();
    w.keyframes().open(broken.fileName());
    CHECK(w.keys() == keys);
    REQUIRE(waitFor([&] {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (widget->objectName() == "errorDialog" && widget->isVisible()) return widget->close();
        return false;
    }));
}

TEST_CASE("a film of keyframes has the pictures that the keys say", "[keyframes][film]") {
    const QTemporaryDir folder;
    OpenKeyframes w;
    // Without keys the dialog says how one gets some.
    withFilmDialog([](FilmDialog& dialog) {
        auto* const model = qobject_cast<QStandardItemModel*>(dialog.findChild<QComboBox*>("filmKind")->model());
        QStandardItem* const item = model->item(static_cast<int>(FilmKind::Keys));
        CHECK_FALSE(item->isEnabled());
        CHECK(item->toolTip().contains("Keyframes"));
        dialog.reject();
    });
    w.child<QAction>("saveFilmAction").trigger();

    w.addThree();
    QSignalSpy saved(&w.controllers().films, &FilmController::saved);
    withFilmDialog([&](FilmDialog& dialog) {
        CHECK(dialog.options().settings.kind == FilmKind::Keys);
        CHECK_FALSE(dialog.findChild<QDoubleSpinBox*>("filmSeconds")->isVisible());
        dialog.findChild<QDoubleSpinBox*>("filmRate")->setValue(2);
        CHECK(dialog.findChild<QLabel*>("filmSummary")->text() == "9 pictures, 4.5 s");
        dialog.findChild<QSpinBox*>("filmWidth")->setValue(64);
        dialog.findChild<QSpinBox*>("filmHeight")->setValue(48);
        dialog.findChild<QCheckBox*>("filmAnnotated")->setChecked(false);
        dialog.findChild<QLineEdit*>("filmPath")->setText(folder.filePath("way"));
        dialog.accept();
    });
    w.click("keyframesFilm");
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    CHECK_FALSE(QFile::exists(folder.filePath("way/picture_00009.png")));
    const Scene scene = w.services().scene();
    const auto renderer = makeRenderer(scene.session.measure->engine, scene.volume);
    const auto pictureAt = [&](double time) {
        const PictureInput input =
            pictureInput(withKeyState(scene, stateAt(w.keys(), time, scene.volume->geometry())), 64, 48);
        return qImageFromImage(renderer->render(input.camera, input.tf, input.settings, {}))
            .convertToFormat(QImage::Format_RGB32);
    };
    const auto filmed = [&](int n) {
        return QImage(folder.filePath(QStringLiteral("way/picture_%1.png").arg(n, 5, 10, QChar('0'))))
            .convertToFormat(QImage::Format_RGB32);
    };
    for (const int n : {0, 3, 8}) CHECK(largestDifference(filmed(n), pictureAt(n / 2.0)) <= 1);
    CHECK(largestDifference(filmed(3), pictureAt(0)) > 20);
}

TEST_CASE("a film that was stopped goes on where it was", "[keyframes][film]") {
    const QTemporaryDir folder;
    OpenKeyframes w(24);
    // Where there is no GPU its pictures take seconds.
    editPart(w.store(), &Session::measure, "Engine", {}, [](MeasureSettings& m) { m.engine = EngineChoice::Cpu; });
    w.addThree();
    FilmController& films = w.controllers().films;
    QSignalSpy saved(&films, &FilmController::saved);
    const auto begin = [&](const QString& name, int width = 240) {
        withFilmDialog([=, &folder](FilmDialog& dialog) {
            dialog.findChild<QDoubleSpinBox*>("filmRate")->setValue(5);
            dialog.findChild<QSpinBox*>("filmWidth")->setValue(width);
            dialog.findChild<QSpinBox*>("filmHeight")->setValue(180);
            dialog.findChild<QCheckBox*>("filmAnnotated")->setChecked(false);
            dialog.findChild<QLineEdit*>("filmPath")->setText(folder.filePath(name));
            dialog.accept();
        });
        w.child<QAction>("saveKeyframeFilmAction").trigger();
    };
    const auto picture = [&](const QString& name, int n) {
        return folder.filePath(QStringLiteral("%1/picture_%2.png").arg(name).arg(n, 5, 10, QChar('0')));
    };
    const auto stopAfter = [&](const QString& name, int n) {
        REQUIRE(waitFor([&] { return QFile::exists(picture(name, n)); }));
        films.cancel();
    };
    begin("whole");
    REQUIRE(waitFor([&] { return saved.count() == 1; }));

    begin("stopped");
    stopAfter("stopped", 2);
    CHECK(w.hasNotice("stopped is not finished"));
    CHECK(w.hasNotice("of its 21 pictures are drawn"));
    // Where the playhead went meanwhile does not matter: it is the same film.
    w.keyframes().goTo(1.3);
    {
        Press cancel("Cancel");
        int returns = 0;
        QTimer after; // the dialog is there again
        after.callOnTimeout([&] {
            auto* const dialog = qobject_cast<FilmDialog*>(QApplication::activeModalWidget());
            if (cancel.asked.isEmpty() || dialog == nullptr) return;
            ++returns;
            dialog->reject();
        });
        after.start(20);
        begin("stopped");
        CHECK(cancel.asked.contains("of its 21 pictures are drawn"));
        CHECK(returns == 1);
    }
    {
        const QDateTime first = QFileInfo(picture("stopped", 0)).lastModified();
        Press rest("Draw the rest");
        begin("stopped");
        CHECK_FALSE(w.hasNotice("stopped is not finished"));
        REQUIRE(waitFor([&] { return saved.count() == 2; }));
        CHECK(QFileInfo(picture("stopped", 0)).lastModified() == first);
    }
    for (int n = 0; n < 21; ++n) CHECK(bytesOf(picture("stopped", n)) == bytesOf(picture("whole", n)));

    // By the notice.
    begin("again");
    stopAfter("again", 2);
    REQUIRE(w.hasNotice("again is not finished"));
    for (const Notice& notice : w.services().notices().all())
        if (notice.text.contains("again is not finished")) {
            REQUIRE(notice.choices.front().text == "Draw the rest");
            const auto act = notice.choices.front().act;
            act();
            break;
        }
    REQUIRE(waitFor([&] { return saved.count() == 3; }));
    CHECK(bytesOf(picture("again", 20)) == bytesOf(picture("whole", 20)));

    // Another film of that name, and this one from its beginning.
    begin("other");
    stopAfter("other", 2);
    {
        Press replace("Replace");
        begin("other", 160);
        CHECK(replace.asked.contains("Another film"));
        REQUIRE(waitFor([&] { return saved.count() == 4; }));
        CHECK(QImage(picture("other", 0)).width() == 160);
    }
    begin("anew");
    stopAfter("anew", 2);
    {
        QFile(picture("anew", 0)).remove();
        QFile::copy(picture("other", 0), picture("anew", 0)); // which shows whether it is drawn again
        Press again("Start again");
        begin("anew");
        REQUIRE(waitFor([&] { return saved.count() == 5; }));
        CHECK(bytesOf(picture("anew", 0)) == bytesOf(picture("whole", 0)));
    }
}
