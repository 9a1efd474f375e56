// Several files at once: chosen, dropped, by a pattern, without headers, again from the list of recent files.
#include "gui_support.h"

#include <algorithm>
#include <fstream>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDir>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <QStatusBar>
#include <QTemporaryDir>
#include <QTimer>
#include <QUrl>

#include "dialogs/raw_dialog.h"
#include "dialogs/save_volume_dialog.h"
#include "dialogs/series_files.h"
#include "store/edits.h"
#include "support/dicom_writer.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kSide = 12;

/// A ball that moves along x with the frame.
std::vector<float> ballOf(int frame) {
    std::vector<float> values;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const double dx = x - 3 - 2 * frame, dy = y - 5.5, dz = z - 5.5;
                values.push_back(static_cast<float>(std::max(0.0, 4 - std::sqrt(dx * dx + dy * dy + dz * dz))));
            }
    return values;
}

/// Frames f1.nrrd, f2.nrrd, f10.nrrd: as text they come in another order.
QStringList writeFrames(const QTemporaryDir& folder) {
    QStringList paths;
    int frame = 0;
    for (const char* name : {"f1.nrrd", "f2.nrrd", "f10.nrrd"}) {
        Geometry geometry;
        geometry.dims = {kSide, kSide, kSide};
        Grid<float> grid(geometry.dims);
        const std::vector<float> values = ballOf(frame++);
        std::copy(values.begin(), values.end(), grid.begin());
        paths << folder.filePath(name);
        writeNrrd(geometry, grid, paths.back().toStdString());
    }
    return paths;
}

/// Big-endian floats, 1e35 where there is no data.
QStringList writeBricks(const QTemporaryDir& folder) {
    QStringList paths;
    for (int frame = 0; frame < 3; ++frame) {
        std::vector<float> values = ballOf(frame);
        values[0] = 1e35f;
        paths << folder.filePath(QStringLiteral("CLOUDf%1.raw").arg(frame + 9, 2, 10, QChar('0')));
        std::ofstream out(paths.back().toStdString(), std::ios::binary);
        for (const float value : values) {
            char bytes[4];
            std::memcpy(bytes, &value, 4);
            std::reverse(bytes, bytes + 4);
            out.write(bytes, 4);
        }
    }
    return paths;
}

void drop(QWidget& widget, const QStringList& paths) {
    QMimeData data;
    QList<QUrl> urls;
    for (const QString& path : paths) urls << QUrl::fromLocalFile(path);
    data.setUrls(urls);
    QDragEnterEvent enter(QPoint(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &enter);
    QDropEvent event(QPointF(50, 50), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
    CHECK(event.isAccepted());
}

/// Answers the modal dialog of this name, once it is there.
void answer(const char* name, const std::function<void(QDialog&)>& with) {
    auto* timer = new QTimer(qApp);
    timer->setInterval(20);
    QObject::connect(timer, &QTimer::timeout, timer, [timer, name = QString(name), with] {
        auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        if (dialog == nullptr || dialog->objectName() != name) return;
        timer->deleteLater();
        timer->stop();
        with(*dialog);
    });
    timer->start();
}

const TimeSeries& seriesOf(OpenWindow& w) { return *w.services().scene().series; }

void waitForSeries(OpenWindow& w, int frames) {
    REQUIRE(waitFor([&] { return seriesOf(w).size() == frames; }));
    w.settle();
}

} // namespace

TEST_CASE("names are ordered as people count", "[series]") {
    const VolumeSource source = sourceOf({"run/f10.raw", "run/f9.raw"});
    CHECK(source.path == "run/f9.raw");
    CHECK(source.more == std::vector<std::string>{"run/f10.raw"});
    CHECK(titleOf(source) == "f9.raw … f10.raw (2 files)");
}

TEST_CASE("files that are dropped together are the frames of a series", "[series]") {
    QSettings().remove("recentFiles");
    const QTemporaryDir folder;
    QStringList paths = writeFrames(folder);
    OpenWindow w;
    const QImage before = w.picture();
    std::reverse(paths.begin(), paths.end());
    drop(w.window, paths);
    waitForSeries(w, 3);
    CHECK(w.services().store().session().variable().source.path == folder.filePath("f1.nrrd").toStdString());
    CHECK(w.services().store().session().variable().source.more.back() == folder.filePath("f10.nrrd").toStdString());
    const QImage first = w.picture();
    CHECK(first != before);
    // Its last frame is that of the last file: the ball has moved by 4 voxels, to x = 7.
    const auto last = w.services().scene().series->load(2);
    const auto valueAt = [&](std::size_t x) { return last->value(x + kSide * (5 + kSide * 5)); };
    CHECK(valueAt(7) > valueAt(3));

    // The list of recent files keeps them all.
    VolumeSource other;
    other.path = "sample:disks";
    other.sampleSize = 16;
    w.open(other);
    w.settle();
    QAction* recent = nullptr;
    for (QAction* action : w.window.findChildren<QAction*>())
        if (action->text() == "f1.nrrd … f10.nrrd (3 files)") recent = action;
    REQUIRE(recent != nullptr);
    recent->trigger();
    waitForSeries(w, 3);
    CHECK(w.picture() == first);
}

TEST_CASE("files are chosen together in the dialog", "[series]") {
    const QTemporaryDir folder;
    const QStringList paths = writeFrames(folder);
    OpenWindow w;
    w.opening().openPaths({paths[2], paths[0], paths[1]}); // as the dialog hands them over
    waitForSeries(w, 3);
    const auto first = w.services().scene().data;
    const QImage series = w.picture();
    w.opening().openPaths({paths[2]});
    waitForSeries(w, 1);
    CHECK_FALSE(w.services().scene().data->samples() == first->samples()); // the last frame alone
    CHECK(w.picture() != series);
    w.opening().openPaths({paths[0]});
    REQUIRE(waitFor([&] { return w.services().scene().data->samples() == first->samples(); }));
}

TEST_CASE("headerless files get one layout: byte order and missing value too", "[series]") {
    const QTemporaryDir folder;
    const QStringList paths = writeBricks(folder);
    OpenWindow w;
    const QImage before = w.picture();
    QString what;
    answer("rawDialog", [&](QDialog& dialog) {
        what = dialog.findChild<QLabel*>("rawWhat")->text();
        auto& type = *dialog.findChild<QComboBox*>("rawType");
        type.setCurrentIndex(type.findData(static_cast<int>(SampleType::F32)));
        for (const char* axis : {"rawDimx", "rawDimy", "rawDimz"}) dialog.findChild<QSpinBox*>(axis)->setValue(kSide);
        dialog.findChild<QComboBox*>("rawEndian")->setCurrentIndex(1);
        QTest::keyClicks(dialog.findChild<QLineEdit*>("rawMissing"), "1e35");
        dialog.accept();
    });
    drop(w.window, paths);
    waitForSeries(w, 3);
    CHECK(what.contains("3 files"));
    const Volume& data = *w.services().scene().data;
    CHECK(data.invalidCount() == 1);
    CHECK_FALSE(data.isValid(0));
    // The largest value is that of the voxel nearest to the middle of the ball, (3, 5.5, 5.5): 4 − √½.
    CHECK(data.dataRange().hi == Approx(4 - std::sqrt(0.5)));
    CHECK(w.picture() != before);
}

TEST_CASE("a series by a pattern, some of its frames", "[series]") {
    const QTemporaryDir folder;
    writeFrames(folder);
    OpenWindow w;
    const QImage before = w.picture();
    answer("seriesDialog", [&](QDialog& dialog) {
        auto& path = *dialog.findChild<QLineEdit*>("seriesPath");
        auto& open = *dialog.findChild<QPushButton*>("seriesOpen");
        auto& found = *dialog.findChild<QLabel*>("seriesFound");
        CHECK_FALSE(open.isEnabled());
        QTest::keyClicks(&path, folder.filePath("g*.nrrd"));
        CHECK(waitFor([&] { return !found.text().isEmpty() && found.text() != "Looking…"; }));
        CHECK_FALSE(open.isEnabled()); // and it says why
        path.selectAll();
        QTest::keyClicks(&path, folder.filePath("f*.nrrd"));
        CHECK(waitFor([&] { return open.isEnabled(); }));
        CHECK(found.text().startsWith("3 frames"));
        dialog.findChild<QSpinBox*>("seriesFirst")->setValue(1);
        QTest::mouseClick(&open, Qt::LeftButton);
    });
    w.child<QAction>("openSeriesAction").trigger();
    waitForSeries(w, 2);
    const auto& frames = w.services().store().session().variable().source.frames;
    REQUIRE(frames);
    CHECK(*frames == FrameRange{1, 2, 1});
    CHECK(w.picture() != before);
}

TEST_CASE("what cannot be opened together is told", "[series]") {
    const QTemporaryDir folder;
    const QStringList paths = writeFrames(folder);
    OpenWindow w;
    const QImage before = w.picture();
    const Session session = w.services().store().session();
    QString said;
    answer("errorDialog", [&](QDialog& dialog) {
        for (const QLabel* label : dialog.findChildren<QLabel*>()) said += label->text();
        dialog.reject();
    });
    QSignalSpy failed(&w.opening(), &OpenController::failed);
    drop(w.window, {paths[0], folder.filePath("work.pellucid.json")});
    CHECK(waitFor([&] { return failed.count() == 1; }));
    CHECK(waitFor([&] { return !said.isEmpty(); }));
    CHECK(said.contains("session must be opened by itself"));
    CHECK(w.services().store().session() == session);
    CHECK(w.picture() == before);
}

namespace {

/// Slices of a bright block in two series: "head" of `slices`, and "thin" of 6.
void writeStudy(const QTemporaryDir& folder, int slices) {
    for (const bool isThin : {false, true})
        for (int n = 0; n < (isThin ? 6 : slices); ++n) {
            test::DicomSlice slice;
            slice.columns = slice.rows = kSide;
            slice.number = n + 1;
            slice.position = "-20\\30\\" + std::to_string(2 * n);
            slice.spacing = "1.25\\0.5"; // between rows, then columns
            slice.description = isThin ? "thin" : "head";
            slice.series = isThin ? "1.2.9" : "1.2.3";
            slice.seriesNumber = isThin ? "7" : "1";
            std::vector<int> values;
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) values.push_back(x > 2 && x < 8 && y > 3 && y < 9 ? 900 + 10 * n : 20);
            slice.pixels = test::words(values);
            const QString name = QStringLiteral("%1%2").arg(isThin ? "b" : "a").arg(n);
            std::ofstream(folder.filePath(name).toStdString(), std::ios::binary) << test::dicomFile(slice);
        }
}

} // namespace

TEST_CASE("of several DICOM series in a dropped folder one is chosen by its picture, and saved as NIfTI", "[series]") {
    const QTemporaryDir folder, other;
    writeStudy(folder, 10);
    OpenWindow w;
    QStringList offered;
    answer("seriesChoiceDialog", [&](QDialog& dialog) {
        auto& list = *dialog.findChild<QListWidget*>("seriesList");
        for (int i = 0; i < list.count(); ++i) offered << list.item(i)->text();
        const QImage empty = list.item(1)->icon().pixmap(96).toImage();
        CHECK(waitFor([&] { return list.item(1)->icon().pixmap(96).toImage() != empty; }));
        list.setCurrentRow(1);
        QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Open), Qt::LeftButton);
    });
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    drop(w.window, {folder.path()});
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    REQUIRE(offered.size() == 2);
    CHECK(offered[0] == "1: head\n12 × 12 pixels, 10 pictures");
    CHECK(offered[1] == "7: thin\n12 × 12 pixels, 6 pictures");
    const Scene& scene = w.services().scene();
    CHECK(scene.volume->dims() == Int3(kSide, kSide, 6));
    CHECK(scene.session.variable().source.array == "7: thin");
    const std::shared_ptr<const Volume> thin = scene.volume;
    CHECK(thin->value(voxelIndex(thin->dims(), 3, 4, 5)) == 950); // of the last slice

    const QString path = other.filePath("thin.nii.gz");
    QSignalSpy saved(&w.saving(), &SaveController::volumeSaved);
    answer("saveVolumeDialog", [&](QDialog& dialog) {
        dialog.findChild<QLineEdit*>("volumePath")->setText(path);
        dialog.accept();
    });
    w.child<QAction>("saveVolumeAction").trigger();
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    drop(w.window, {path});
    REQUIRE(waitFor([&] { return opened.count() == 2; }));
    const Volume& again = *scene.volume;
    REQUIRE(&again != thin.get());
    CHECK(again.format == "NIfTI");
    CHECK(again.dims() == thin->dims());
    CHECK(again.samples() == thin->samples());
    CHECK(again.geometry().spacing == Vec3(0.5, 1.25, 2));
    CHECK(again.geometry().worldAxes == WorldAxes::Patient);
    for (const Vec3& voxel : {Vec3(0), Vec3(11, 0, 0), Vec3(0, 11, 0), Vec3(0, 0, 5)}) {
        const Vec3 place = Vec3(-20, 30, 0) + voxel * Vec3(0.5, 1.25, 2);
        CHECK(glm::length(again.geometry().worldFromVoxel(voxel) - place) < 1e-5);
    }
}

TEST_CASE("nothing is opened where no DICOM series is chosen, and a broken slice is named", "[series]") {
    const QTemporaryDir folder;
    writeStudy(folder, 8);
    OpenWindow w;
    const Session session = w.services().store().session();
    bool asked = false;
    answer("seriesChoiceDialog", [&](QDialog& dialog) {
        asked = true;
        dialog.reject();
    });
    w.opening().openPath(folder.path());
    REQUIRE(waitFor([&] { return asked && !w.opening().isBusy(); }));
    CHECK(w.services().store().session() == session);

    const QString slice = folder.filePath("a3");
    REQUIRE(QFile::resize(slice, QFileInfo(slice).size() - 20));
    QString said;
    answer("seriesChoiceDialog", [&](QDialog& dialog) { dialog.accept(); });
    answer("errorDialog", [&](QDialog& dialog) {
        for (const QLabel* label : dialog.findChildren<QLabel*>()) said += label->text() + "\n";
        dialog.reject();
    });
    w.opening().openPath(folder.path());
    REQUIRE(waitFor([&] { return !said.isEmpty(); }));
    CHECK(said.contains("a3"));
    CHECK(said.contains("268 of 288 bytes"));
    CHECK(w.services().store().session() == session);
}

TEST_CASE("of several arrays in a VTK file one is chosen before it is read", "[series]") {
    const QTemporaryDir folder;
    const auto values = [](int first) {
        std::string text;
        for (int i = 0; i < 27; ++i) text += std::to_string(first + i) + " ";
        return text;
    };
    const auto vtiOf = [&](const std::vector<std::string>& names) {
        std::string text = "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\" version=\"1.0\"><ImageData "
                           "WholeExtent=\"0 2 0 2 0 2\"><Piece Extent=\"0 2 0 2 0 2\"><PointData>";
        for (std::size_t i = 0; i < names.size(); ++i)
            text += "<DataArray type=\"Int32\" Name=\"" + names[i] + "\" format=\"ascii\">" +
                    values(static_cast<int>(100 * i)) + "</DataArray>";
        return text + "</PointData></Piece></ImageData></VTKFile>";
    };
    const auto write = [&](const char* name, const std::string& text) {
        std::ofstream(folder.filePath(name).toStdString()) << text;
        return folder.filePath(name);
    };
    const std::string legacy = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\n"
                               "SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 27\nSCALARS density int 1\n"
                               "LOOKUP_TABLE default\n" +
                               values(0) + "\nSCALARS speed int 1\nLOOKUP_TABLE default\n" + values(100) + "\n";
    OpenWindow w;
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    for (const QString& path : {write("two.vti", vtiOf({"density", "speed"})), write("two.vtk", legacy)}) {
        CAPTURE(path.toStdString());
        QStringList offered;
        answer("seriesChoiceDialog", [&](QDialog& dialog) {
            auto& list = *dialog.findChild<QListWidget*>("seriesList");
            for (int i = 0; i < list.count(); ++i) offered << list.item(i)->text();
            list.setCurrentRow(1);
            dialog.accept();
        });
        opened.clear();
        w.opening().openPath(path);
        REQUIRE(waitFor([&] { return opened.count() == 1; }));
        CHECK(offered == QStringList{"density", "speed"});
        CHECK(w.services().scene().session.variable().source.array == "speed");
        CHECK(w.services().scene().data->dataRange() == ValueRange{100, 126});
    }
    // Of one there is nothing to ask.
    opened.clear();
    w.opening().openPath(write("one.vti", vtiOf({"density"})));
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(w.services().scene().data->dataRange() == ValueRange{0, 26});
}

TEST_CASE("a header that names a file outside its folder is opened only after a question", "[series]") {
    const QTemporaryDir folder;
    REQUIRE(QDir(folder.path()).mkdir("headers"));
    std::ofstream(folder.filePath("values.raw").toStdString(), std::ios::binary)
        << std::string(kSide * kSide * kSide, 'a');
    const QString header = folder.filePath("headers/a.nhdr");
    std::ofstream(header.toStdString()) << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n"
                                           "data file: ../values.raw\n";
    OpenWindow w;
    QSignalSpy opened(&w.opening(), &OpenController::opened), failed(&w.opening(), &OpenController::failed);
    QString asked;
    answer("askOutside", [&](QDialog& dialog) {
        asked = dynamic_cast<QMessageBox&>(dialog).text();
        dialog.reject();
    });
    w.opening().openPath(header);
    REQUIRE(waitFor([&] { return failed.count() == 1; }));
    CHECK(asked.contains("../values.raw"));
    CHECK(opened.count() == 0);
    answer("askOutside", [&](QDialog& dialog) {
        QTest::mouseClick(dynamic_cast<QMessageBox&>(dialog).button(QMessageBox::Open), Qt::LeftButton);
    });
    w.opening().openPath(header);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    CHECK(w.services().scene().volume->dims() == Int3(kSide));
}

TEST_CASE("the volume that is shown is saved in another format", "[series]") {
    const QTemporaryDir folder;
    OpenWindow w;
    const Volume& shown = *w.services().scene().volume;
    CHECK(w.child<QAction>("saveVolumeAction").isEnabled());
    QSignalSpy saved(&w.saving(), &SaveController::volumeSaved);
    for (const char* name : {"a.nii.gz", "a.mhd", "a.vti"}) {
        VolumeSource source;
        source.path = folder.filePath(name).toStdString();
        w.saving().saveVolume({QString::fromStdString(source.path)});
        REQUIRE(waitFor([&] { return saved.count() == 1; }));
        saved.clear();
        CHECK(loadVolume(source).samples() == shown.samples());
    }
    QString said;
    answer("errorDialog", [&](QDialog& dialog) {
        for (const QLabel* label : dialog.findChildren<QLabel*>()) said += label->text();
        dialog.reject();
    });
    w.saving().saveVolume({folder.filePath("a.png")});
    REQUIRE(waitFor([&] { return !said.isEmpty(); }));
    CHECK(said.contains(".nii.gz"));
}

TEST_CASE("the dialog saves what the clip box leaves, coarser and in another type", "[series]") {
    const QTemporaryDir folder;
    OpenWindow w;
    const Int3 dims = w.services().scene().volume->dims();
    editPart(w.services().store(), &Session::clipping, "clip", {}, [](Clipping& clip) { clip.hi.x = 0.5; });
    QSignalSpy saved(&w.saving(), &SaveController::volumeSaved);
    const QString path = folder.filePath("half.nii");
    QString summary;
    answer("saveVolumeDialog", [&](QDialog& dialog) {
        dialog.findChild<QLineEdit*>("volumePath")->setText(path);
        dialog.findChild<QCheckBox*>("volumeClipped")->setChecked(true);
        dialog.findChild<QComboBox*>("volumeCoarser")->setCurrentIndex(1);
        auto* type = dialog.findChild<QComboBox*>("volumeType");
        type->setCurrentIndex(type->findText("f32"));
        CHECK_FALSE(dialog.findChild<QComboBox*>("volumeFrames")->isVisibleTo(&dialog)); // there is one
        summary = dialog.findChild<QLabel*>("volumeSummary")->text();
        dialog.accept();
    });
    w.child<QAction>("saveVolumeAction").trigger();
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    VolumeSource source;
    source.path = path.toStdString();
    const Volume read = loadVolume(source);
    const Int3 half((dims.x + 1) / 2, dims.y, dims.z);
    CHECK(read.dims() == (half + 1) / 2);
    CHECK(read.sampleType() == SampleType::F32);
    CHECK(summary.contains(QStringLiteral("%1 × %2 × %3").arg(read.dims().x).arg(read.dims().y).arg(read.dims().z)));
    CHECK(summary.contains("f32"));
    // The message has the place of the hint to itself.
    QStatusBar& bar = *w.window.statusBar();
    REQUIRE(waitFor([&] { return bar.currentMessage().contains("half.nii"); }));
    CHECK_FALSE(w.child<QLabel>("hintLabel").isVisible());
    bar.clearMessage();
    CHECK(w.child<QLabel>("hintLabel").isVisible());
}
