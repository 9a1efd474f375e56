// Films from the window: what the dialog offers, and what comes of it.
#include "gui_support.h"

#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTimer>

#include "dialogs/film_dialog.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

FilmController& filmsOf(OpenWindow& w) { return w.controllers().films; }

/// Answers the dialog once it is open.
void withDialog(const std::function<void(FilmDialog&)>& answer) {
    QTimer::singleShot(0, [answer] {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (auto* dialog = qobject_cast<FilmDialog*>(widget)) return answer(*dialog);
    });
}

} // namespace

TEST_CASE("the film dialog shows what its kind has, and how long the film will be", "[film]") {
    FilmOptions offered;
    FilmDialog dialog(offered, {640, 480}, 20, 4.0, true);
    dialog.show();
    const auto shown = [&](const char* name) { return dialog.findChild<QWidget*>(name)->isVisible(); };
    auto& kind = *dialog.findChild<QComboBox*>("filmKind");
    auto& summary = *dialog.findChild<QLabel*>("filmSummary");
    CHECK((shown("filmDegrees") && shown("filmSeconds") && !shown("filmViews")));
    CHECK(summary.text() == "200 pictures, 8.0 s");
    kind.setCurrentIndex(1);
    CHECK((!shown("filmDegrees") && !shown("filmSeconds") && !shown("filmViews")));
    CHECK(summary.text() == "20 pictures, 0.8 s");
    kind.setCurrentIndex(2);
    CHECK((!shown("filmDegrees") && shown("filmSeconds") && shown("filmViews")));
    dialog.setPresentView("30.0,20.0,1.00");
    auto& views = *dialog.findChild<QLineEdit*>("filmViews");
    views.setText("left");
    dialog.findChild<QPushButton*>("filmAddView")->click();
    CHECK(views.text() == "left; 30.0,20.0,1.00");
    dialog.findChild<QDoubleSpinBox*>("filmSeconds")->setValue(2);
    CHECK(summary.text() == "50 pictures, 2.0 s");
    CHECK(dialog.options().settings == FilmSettings{FilmKind::Views, 2, 25, 360});

    // The list says what the boxes say.
    const auto& preset = *dialog.findChild<QComboBox*>("filmPreset");
    auto &width = *dialog.findChild<QSpinBox*>("filmWidth"), &height = *dialog.findChild<QSpinBox*>("filmHeight");
    CHECK(preset.currentText() == "HD (1280 × 720)");
    width.setValue(320);
    CHECK(preset.currentText() == "Custom");
    width.setValue(640);
    height.setValue(480);
    CHECK(preset.currentText() == "As seen (640 × 480)");
}

TEST_CASE("a film of the window is saved in the background, and can be cancelled", "[film]") {
    const QTemporaryDir folder;
    OpenWindow w(16);
    QSignalSpy saved(&filmsOf(w), &FilmController::saved);
    const auto fill = [&](const QString& name, double seconds) {
        withDialog([=, &folder](FilmDialog& dialog) {
            dialog.findChild<QDoubleSpinBox*>("filmSeconds")->setValue(seconds);
            dialog.findChild<QDoubleSpinBox*>("filmRate")->setValue(4);
            dialog.findChild<QSpinBox*>("filmWidth")->setValue(48);
            dialog.findChild<QSpinBox*>("filmHeight")->setValue(32);
            dialog.findChild<QLineEdit*>("filmPath")->setText(folder.filePath(name));
            dialog.accept();
        });
        w.child<QAction>("saveFilmAction").trigger();
    };
    fill("turn", 1);
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    CHECK(QImage(folder.filePath("turn/picture_00003.png")).size() == QSize(48, 32));
    CHECK_FALSE(QFile::exists(folder.filePath("turn/picture_00004.png")));
    // The view of the window did not turn.
    CHECK(w.document().stepCount() == 0);
    QSignalSpy cancelled(&filmsOf(w), &FilmController::cancelled);
    fill("long", 3600);
    CHECK(filmsOf(w).isBusy());
    CHECK(w.child<QLabel>("volumeLabel").isVisible());
    filmsOf(w).cancel();
    CHECK(cancelled.count() == 1);
    REQUIRE(waitFor([&] { return !filmsOf(w).isBusy(); }));
    CHECK(saved.count() == 1);
}

TEST_CASE("what is wrong with a film is read before its dialog comes back", "[film]") {
    const QTemporaryDir folder;
    OpenWindow w(16);
    const auto visible = [](const char* name) -> QDialog* {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (auto* dialog = qobject_cast<QDialog*>(widget);
                dialog != nullptr && dialog->objectName() == name && dialog->isVisible())
                return dialog;
        return nullptr;
    };
    QFile taken(folder.filePath("taken")); // a file, where a folder is wanted
    REQUIRE(taken.open(QIODevice::WriteOnly));
    int errors = 0, returns = 0;
    for (const QString& name : {taken.fileName(), folder.filePath("turn.avi")}) { // nor is that a name of a folder
        withDialog([&](FilmDialog& dialog) {
            dialog.findChild<QLineEdit*>("filmPath")->setText(name);
            // The error is alone on the screen …
            QTimer::singleShot(0, &dialog, [&] {
                QDialog* error = visible("errorDialog");
                REQUIRE(error != nullptr);
                CHECK(!dialog.isVisible());
                ++errors;
                // … and after it the dialog is there again, as it was filled in.
                QTimer::singleShot(0, &dialog, [&] {
                    CHECK(dialog.isVisible());
                    CHECK(visible("errorDialog") == nullptr);
                    CHECK(dialog.findChild<QLineEdit*>("filmPath")->text() == name);
                    ++returns;
                    dialog.reject();
                });
                error->accept();
            });
            dialog.accept();
        });
        w.child<QAction>("saveFilmAction").trigger();
    }
    CHECK(errors == 2);
    CHECK(returns == 2);
    CHECK_FALSE(QFile::exists(folder.filePath("turn.avi")));
}
