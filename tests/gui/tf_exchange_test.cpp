// Transfer functions for other programs, from the window.
#include "gui_support.h"

#include <algorithm>

#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDialog>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QTimer>

#include "controllers/tf_exchange_controller.h"
#include "dialogs/tf_parts_dialog.h"
#include "support/temp_folder.h"
#include "tf/formats/tf_file.h"
#include "tf/formats/tf_json.h"

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

bool says(OpenWindow& w, const QString& words) {
    return std::ranges::any_of(w.services().notices().all(), [&](const Notice& n) { return n.text.contains(words); });
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
    CHECK(says(w, "3 features are not stored"));
    CHECK_FALSE(says(w, "is known"));
}

TEST_CASE("what another program lays over the data keeps its values in the window", "[window][exchange]") {
    OpenWindow w;
    const test::TempFolder folder;
    TransferFunction ramp;
    ramp.points = {{0, 0.2, {0, 0, 1}, false, {}}, {1, 0.6, {0, 0, 1}, false, {}}};
    ramp.range = ValueRange{50, 150};
    writeTf(ramp, folder.path("ramp.tf.json"));
    w.opening().openTf(QString::fromStdString(folder.path("ramp.tf.json")));
    w.settle();
    REQUIRE(w.document().volume()->range() == ValueRange{50, 150});
    const ValueRange data = w.document().volume()->dataRange();
    REQUIRE((data.lo < 40 && data.hi > 160));
    TfExchangeController exchange(w.services(), w.opening());
    const QString file = QString::fromStdString(folder.path("ramp.itksnap.xml"));
    REQUIRE(exchange.exportTf(itkSnapFormat(), file));

    w.opening().openTf(file);
    w.settle();
    CHECK(w.document().volume()->range() == data);
    const auto opacityOf = [&](double value) {
        return w.document().tf().opacity((value - data.lo) / (data.hi - data.lo));
    };
    CHECK(opacityOf(40) == Approx(0.2).margin(0.003)); // steps of 8 bits
    CHECK(opacityOf(100) == Approx(0.4).margin(0.003));
    CHECK(opacityOf(160) == Approx(0.6).margin(0.003));
    CHECK(says(w, "positions 0 to 1 are put on the values"));
}

TEST_CASE("the window asks which of several transfer functions in a file is meant", "[window][exchange]") {
    OpenWindow w;
    const test::TempFolder folder;
    const auto preset = [](const std::string& name, const std::string& color) {
        return R"({"Name": ")" + name + R"(", "RGBPoints": [0, )" + color + ", 1, " + color +
               R"(], "Points": [0, 0.2, 0.5, 0, 1, 0.6, 0.5, 0]})";
    };
    const QString file = QString::fromStdString(folder.write("several.json", "[" + preset("red", "1, 0, 0") + ", " +
                                                                                 preset("green", "0, 1, 0") + ", " +
                                                                                 preset("blue", "0, 0, 1") + "]"));
    const auto choose = [](const QString& name) {
        return [name](QDialog& dialog) {
            auto& list = *dialog.findChild<QListWidget*>("presetList");
            CHECK(list.count() == 3);
            const QList<QListWidgetItem*> found = list.findItems(name, Qt::MatchExactly);
            CHECK(found.size() == 1);
            if (!found.isEmpty()) list.setCurrentItem(found.front());
            dialog.accept();
        };
    };
    const auto middle = [&] { return w.document().tf().color(0.5); };
    const TransferFunction before = w.document().tf();

    whenOpen(w.window, "presetDialog", [](QDialog& dialog) {
        CHECK(dialog.findChild<QLabel*>("presetWhat")->text().startsWith("several.json holds 3"));
        dialog.reject();
    });
    w.opening().openPath(file);
    w.settle();
    CHECK(w.document().tf() == before);

    whenOpen(w.window, "presetDialog", choose("blue"));
    w.opening().openPath(file); // as it is dropped
    w.settle();
    CHECK(middle().b == Approx(1));
    CHECK(middle().r == Approx(0).margin(1e-9));
    CHECK(says(w, "positions 0 to 1 are put on the values"));
    CHECK_FALSE(says(w, "takes another"));

    // At the start of a window, too; who gives up gets the automatic start.
    whenOpen(w.window, "presetDialog", choose("green"));
    w.opening().openAtStart({"sample:disks"}, file);
    w.settle();
    CHECK(middle().g == Approx(1));
    CHECK(middle().b == Approx(0).margin(1e-9));
    whenOpen(w.window, "presetDialog", [](QDialog& dialog) { dialog.reject(); });
    w.opening().openAtStart({"sample:disks"}, file);
    w.settle();
    CHECK(w.document().volume()->title == "disks");
    CHECK(w.document().tf().features.size() > 0); // a preset has none
    whenOpen(w.window, "presetDialog", choose("blue"));
    w.opening().openPath(file);
    w.settle();

    // The same question comes before that for the parts.
    const double opacity = w.document().tf().opacity(0.25);
    auto* const files = new QTimer(&w.window);
    QObject::connect(files, &QTimer::timeout, &w.window, [&w, &file, files] {
        auto* dialog = w.window.findChild<QFileDialog*>();
        if (dialog == nullptr || !dialog->isVisible()) return;
        files->stop();
        dialog->findChild<QLineEdit*>("fileNameEdit")->setText(file);
        QMetaObject::invokeMethod(dialog, "accept");
    });
    files->start(10);
    whenOpen(w.window, "presetDialog", choose("green"));
    whenOpen(w.window, "tfPartsDialog", [](QDialog& dialog) {
        dialog.findChild<QCheckBox*>("tfPartOpacities")->setChecked(false);
        dialog.accept();
    });
    w.child<QAction>("openTfPartsAction").trigger();
    w.settle();
    CHECK(middle().g == Approx(1));
    CHECK(middle().b == Approx(0).margin(1e-9));
    CHECK(w.document().tf().opacity(0.25) == Approx(opacity));
}

TEST_CASE("colours, opacities and range of a file are taken one by one in the window", "[window][exchange]") {
    OpenWindow w;
    const test::TempFolder folder;
    TransferFunction blue;
    blue.points = {{0, 0.9, {0, 0, 1}, false, {}}, {1, 0.9, {0, 0, 1}, false, {}}};
    const ValueRange window = w.document().volume()->range();
    blue.range = ValueRange{window.lo, window.lo + 2 * (window.hi - window.lo)};
    const std::string file = folder.path("blue.tf.json");
    writeTf(blue, file);
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
