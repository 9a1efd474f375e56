// Transfer functions for other programs, from the window.
#include "gui_support.h"

#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>

#include "controllers/tf_exchange_controller.h"
#include "dialogs/tf_parts_dialog.h"
#include "support/temp_folder.h"
#include "tf/formats/tf_file.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Answers the dialog of this name once it is open.
template <class Answer>
void whenOpen(MainWindow& window, const char* name, const Answer& answer) {
    auto* timer = new QTimer(&window);
    QObject::connect(timer, &QTimer::timeout, &window, [&window, name, answer, timer] {
        auto* dialog = window.findChild<QDialog*>(name);
        if (dialog == nullptr || !dialog->isVisible()) return;
        timer->stop();
        timer->deleteLater();
        answer(*dialog);
    });
    timer->start(10);
}

} // namespace

TEST_CASE("the window exports a transfer function and says what is lost", "[window][exchange]") {
    OpenWindow w;
    const test::TempFolder folder;
    const QString file = QString::fromStdString(folder.path("mine.vp"));
    whenOpen(w.window, "exportTfDialog", [&file](QDialog& dialog) {
        auto& format = *dialog.findChild<QComboBox*>("exportTfFormat");
        auto& path = *dialog.findChild<QLineEdit*>("exportTfPath");
        auto& losses = *dialog.findChild<QLabel*>("exportTfLosses");
        format.setCurrentIndex(format.findData("voreen"));
        CHECK(path.text().endsWith(".tfi"));
        CHECK(losses.text().contains("256 steps"));
        format.setCurrentIndex(format.findData("slicer-vp"));
        CHECK(path.text().endsWith(".vp"));
        CHECK(losses.text().contains("features are not stored"));
        CHECK_FALSE(losses.text().contains("256 steps"));
        path.setText(file);
        dialog.accept();
    });
    w.child<QAction>("exportTfAction").trigger();
    const Geometry& geometry = w.document().volume()->geometry();
    const TransferFunction written = forVolume(openTfFile(file.toStdString()), geometry);
    CHECK(written.range == w.document().volume()->range());
    CHECK(written.opacity(0.5) == Approx(w.document().tf().opacity(0.5)).margin(1e-6));
    // Opened again it is a step of the history, and saving asks for a name of its own.
    w.opening().openPath(file);
    w.settle();
    CHECK(w.document().tf().opacity(0.5) == Approx(0.5).margin(1e-6));
    CHECK(w.document().tf().features.size() == 3);
    CHECK(w.saving().tfPath().isEmpty());
}

TEST_CASE("lines of Python go to the clipboard", "[window][exchange]") {
    OpenWindow w;
    for (const char* name : {"paraview", "slicer", "pyvista", "napari"}) {
        INFO(name);
        QApplication::clipboard()->clear();
        w.child<QAction>((std::string("copyTf_") + name).c_str()).trigger();
        CHECK(QApplication::clipboard()->text().contains("points = ["));
        CHECK(QApplication::clipboard()->text().contains("import"));
    }
}

TEST_CASE("colours, opacities and range of a file are taken one by one in the window", "[window][exchange]") {
    OpenWindow w;
    const test::TempFolder folder;
    TransferFunction blue;
    blue.points = {{0, 0.9, {0, 0, 1}, false, {}}, {1, 0.9, {0, 0, 1}, false, {}}};
    const ValueRange window = w.document().volume()->range();
    blue.range = ValueRange{window.lo, window.lo + 2 * (window.hi - window.lo)};
    const std::string file = folder.path("blue.tf.json");
    writeTfFile(blue, {}, file);
    const TransferFunction before = w.document().tf();
    TfExchangeController exchange(w.services(), w.opening());

    exchange.openParts(QString::fromStdString(file), {true, false, false});
    w.settle();
    CHECK(w.document().tf().color(0.5) == Rgb{0, 0, 1});
    CHECK(w.document().tf().opacity(0.5) == Approx(before.opacity(0.5)));
    CHECK(w.document().tf().features.size() == before.features.size());
    w.document().undo();
    w.settle();
    CHECK(w.document().tf() == before);

    exchange.openParts(QString::fromStdString(file), {false, false, true});
    w.settle();
    CHECK(w.document().volume()->range() == *blue.range);
    CHECK(w.document().tf().opacity(0.25) == Approx(before.opacity(0.5)));

    TfPartsDialog dialog("a.vtkjs.json", {true, false, false}, {"no opacities"});
    CHECK_FALSE(dialog.findChild<QCheckBox*>("tfPartOpacities")->isEnabled());
    CHECK(dialog.parts().colors);
    CHECK_FALSE(dialog.parts().opacities);
    CHECK(dialog.findChild<QLabel*>("tfPartNotices")->text() == "no opacities");
}
