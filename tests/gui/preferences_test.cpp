// What people set for this machine: theme, mouse, memory, threads, recent files and their pictures.
#include "gui_support.h"

#include <cmath>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QFileInfo>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QRegularExpression>
#include <QSettings>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolButton>
#include <QTreeWidget>
#include <QWheelEvent>

#include <glm/geometric.hpp>

#include "base/memory.h"
#include "base/parallel.h"
#include "dialogs/preferences_dialog.h"
#include "render/camera_motion.h"
#include "services/recent_files.h"
#include "widgets/mouse_scheme.h"
#include "window/welcome_card.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// As the program came, before and after.
struct PlainPreferences {
    PlainPreferences() { restore(); }
    ~PlainPreferences() { restore(); }
    static void restore() {
        keepPreferences({});
        applyPreferences({});
        applyTheme(*qApp, Theme::Dark);
        clearRecent();
    }
};

/// What a drag has done, told from the cameras before and after; empty: nothing.
std::optional<Motion> seenMotion(const Camera& before, const Camera& after) {
    const auto apart = [](const Vec3& a, const Vec3& b) { return glm::length(a - b) > 1e-6; };
    if (apart(before.center, after.center)) return Motion::Pan;
    if (apart(before.forward(), after.forward())) return Motion::Rotate;
    if (apart(before.eye, after.eye) || before.fovY != after.fovY) return Motion::Zoom;
    if (apart(before.trueUp(), after.trueUp())) return Motion::Roll;
    return {};
}

constexpr auto kNone = Qt::NoModifier;
constexpr auto kShift = Qt::ShiftModifier;
constexpr auto kCtrl = Qt::ControlModifier;

/// The manuals' rows, by key: what left, middle and right do.
struct SchemeRow {
    MouseScheme scheme;
    Qt::KeyboardModifiers keys;
    Motion left, middle, right;
};
const SchemeRow kRows[] = {
    {MouseScheme::Pellucid, kNone, Motion::Rotate, Motion::Pan, Motion::Zoom},
    {MouseScheme::Pellucid, kShift, Motion::Pan, Motion::Pan, Motion::Zoom},
    {MouseScheme::Pellucid, kCtrl, Motion::Light, Motion::Pan, Motion::Zoom},
    {MouseScheme::ParaView, kNone, Motion::Rotate, Motion::Pan, Motion::Zoom},
    {MouseScheme::ParaView, kShift, Motion::Roll, Motion::Rotate, Motion::Pan},
    {MouseScheme::ParaView, kCtrl, Motion::Zoom, Motion::Rotate, Motion::Zoom},
    {MouseScheme::ParaView, kCtrl | Qt::AltModifier, Motion::Light, Motion::Pan, Motion::Zoom},
    {MouseScheme::Slicer, kNone, Motion::Rotate, Motion::Pan, Motion::Zoom},
    {MouseScheme::Slicer, kShift, Motion::Pan, Motion::Pan, Motion::Zoom},
    {MouseScheme::Slicer, kCtrl, Motion::Roll, Motion::Pan, Motion::Zoom},
    {MouseScheme::Slicer, kCtrl | kShift, Motion::Zoom, Motion::Pan, Motion::Zoom},
    {MouseScheme::Slicer, kCtrl | Qt::AltModifier, Motion::Light, Motion::Pan, Motion::Zoom},
};

QString writtenBoxes(const QTemporaryDir& folder, const QString& name) {
    Grid<float> values({16, 16, 16});
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 16 + (i / 256) * 4);
    const QString path = folder.filePath(name);
    writeNrrd(Geometry{{16, 16, 16}, Vec3(1), Vec3(0), Mat3(1)}, values, path.toStdString());
    return path;
}

void openFile(OpenWindow& w, const QString& path) {
    VolumeSource source;
    source.path = path.toStdString();
    w.open(source);
    w.settle();
}

/// Over all channels of pixels, of 255.
double meanDifference(const QImage& a, const QImage& b) {
    REQUIRE(a.size() == b.size());
    double sum = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            sum += std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) + std::abs(qBlue(p) - qBlue(q));
        }
    return sum / (3.0 * a.width() * a.height());
}

PreferencesDialog::Hooks quietHooks() {
    return {[] {}, [] { clearRecent(); }, [] { return !recentFiles().empty(); }};
}

} // namespace

TEST_CASE("each scheme of the mouse does what its program does", "[preferences][mouse]") {
    const PlainPreferences plain;
    OpenWindow w;
    VolumeView& view = w.view();
    const QPointF from(view.width() * 0.5, view.height() * 0.4), to = from + QPointF(30, 40);
    const Camera start = w.document().camera();
    for (const SchemeRow& row : kRows) {
        setMouseScheme(row.scheme);
        const std::pair<Qt::MouseButton, Motion> drags[] = {
            {Qt::LeftButton, row.left}, {Qt::MiddleButton, row.middle}, {Qt::RightButton, row.right}};
        for (const auto& [button, motion] : drags) {
            INFO(name(row.scheme) << ", keys " << int(row.keys) << ", button " << int(button));
            w.document().setCamera(start);
            const Vec3 light = w.services().store().session().display->light.direction;
            drag(view, from, to, button, row.keys);
            const Vec3 now = w.services().store().session().display->light.direction;
            if (motion == Motion::Light) {
                CHECK_FALSE(seenMotion(start, w.document().camera()));
                CHECK(glm::length(now - light) > 1e-3);
                w.document().undo();
            } else {
                CHECK(seenMotion(start, w.document().camera()) == motion);
                CHECK(now == light);
            }
        }
    }
}

TEST_CASE("the mouse zooms and rolls in the direction of its scheme", "[preferences][mouse]") {
    const PlainPreferences plain;
    OpenWindow w;
    VolumeView& view = w.view();
    const Camera start = w.document().camera();
    const Geometry& geometry = w.document().volume()->geometry();
    const double zoom = viewAngles(start, geometry).zoom;
    const QPointF middle = QRectF(view.rect()).center();
    for (const MouseScheme scheme : allOf<MouseScheme>()) {
        INFO(name(scheme));
        setMouseScheme(scheme);
        // Down comes closer in ParaView and 3D Slicer, up in Pellucid; the wheel's way is the same in all.
        w.document().setCamera(start);
        drag(view, middle, middle + QPointF(0, 50), Qt::RightButton);
        CHECK((viewAngles(w.document().camera(), geometry).zoom > zoom) == (scheme != MouseScheme::Pellucid));
        w.document().setCamera(start);
        QWheelEvent wheel(middle, view.mapToGlobal(middle), {}, {0, 120}, Qt::NoButton, Qt::NoModifier,
                          Qt::NoScrollPhase, false);
        QCoreApplication::sendEvent(&view, &wheel);
        CHECK(viewAngles(w.document().camera(), geometry).zoom > zoom);
    }
    // From the right of the middle to above it is a quarter, counterclockwise: what was at the right comes up.
    w.document().setCamera(start);
    setMouseScheme(MouseScheme::Slicer);
    drag(view, middle + QPointF(80, 0), middle + QPointF(0, -80), Qt::LeftButton, Qt::ControlModifier);
    CHECK(glm::length(w.document().camera().trueUp() - start.right()) < 0.02);
    CHECK(glm::length(w.document().camera().eye - start.eye) < 1e-9);
}

TEST_CASE("preferences hold at once, are kept, and go back to what they were", "[preferences]") {
    const PlainPreferences plain;
    PreferencesDialog dialog(quietHooks(), nullptr);
    dialog.show();
    auto& theme = *dialog.findChild<QComboBox*>("preferencesTheme");
    auto& mouse = *dialog.findChild<QComboBox*>("preferencesMouse");
    auto& memory = *dialog.findChild<QDoubleSpinBox*>("preferencesMemoryGiB");
    auto& threads = *dialog.findChild<QSpinBox*>("preferencesThreads");
    auto& table = *dialog.findChild<QTreeWidget*>("preferencesMouseTable");
    CHECK(memory.text() == "what is free");
    CHECK(threads.text() == "all cores");
    const int cores = threadCount();

    QTest::keyClick(&theme, Qt::Key_Down); // from dark to light
    CHECK(appliedTheme() == Theme::Light);
    const QString ofPellucid = table.topLevelItem(1)->text(0);
    QTest::keyClick(&mouse, Qt::Key_Down);
    CHECK(mouseScheme() == MouseScheme::ParaView);
    CHECK(table.topLevelItem(1)->text(0) != ofPellucid);
    CHECK(table.topLevelItem(1)->text(1) == "pan");
    memory.setFocus();
    memory.selectAll();
    QTest::keyClicks(&memory, "512");
    QTest::keyClick(&memory, Qt::Key_Return);
    CHECK(availableMemoryBytes() <= std::uint64_t{512} << 30);
    CHECK(availableMemoryBytes() > std::uint64_t{400} << 30); // more than machines have: the limit alone counts
    threads.selectAll();
    QTest::keyClicks(&threads, "3");
    QTest::keyClick(&threads, Qt::Key_Return);
    CHECK(threadCount() == 3);
    QTest::mouseClick(dialog.findChild<QCheckBox*>("preferencesRecentPictures"), Qt::LeftButton, {}, {8, 8});

    const Preferences kept = keptPreferences(); // what the next start applies
    CHECK(kept.theme == Theme::Light);
    CHECK(kept.mouse == MouseScheme::ParaView);
    CHECK(kept.memoryGiB == 512.0);
    CHECK(kept.threads == 3);
    CHECK_FALSE(kept.recentPictures);
    // A second dialog shows them.
    PreferencesDialog again(quietHooks(), nullptr);
    CHECK(again.findChild<QComboBox*>("preferencesTheme")->currentText() == "Light");
    CHECK(again.findChild<QSpinBox*>("preferencesThreads")->value() == 3);

    QTest::mouseClick(dialog.findChild<QPushButton*>("preferencesDefaults"), Qt::LeftButton);
    CHECK(appliedTheme() == Theme::Dark);
    CHECK(mouseScheme() == MouseScheme::Pellucid);
    CHECK(threadCount() == cores);
    CHECK(memory.text() == "what is free");
    CHECK_FALSE(keptPreferences().memoryGiB);
    for (const char* key : {"theme", "mouse", "memoryGiB", "threads", "recentPictures"})
        CHECK_FALSE(QSettings().contains(key));
}

TEST_CASE("preferences that make no sense are as the program came", "[preferences]") {
    const PlainPreferences plain;
    QSettings().setValue("threads", "-4");
    QSettings().setValue("memoryGiB", "much");
    QSettings().setValue("mouse", "hamster");
    QSettings().setValue("recentCount", "5");
    const Preferences kept = keptPreferences();
    CHECK(kept.threads == 0);
    CHECK_FALSE(kept.memoryGiB);
    CHECK(kept.mouse == MouseScheme::Pellucid);
    CHECK(kept.recentCount == 5);
}

TEST_CASE("recent files have pictures of how they were left", "[preferences][recent]") {
    const PlainPreferences plain;
    const QTemporaryDir folder;
    const QString first = writtenBoxes(folder, "first.nrrd"), second = writtenBoxes(folder, "second.nrrd");
    QImage left;
    {
        OpenWindow w;
        openFile(w, first);
        CHECK(recentFiles().front().pictureFile.isEmpty());
        drag(w.view(), {100, 100}, {180, 130});
        left = w.picture();
        openFile(w, second); // takes its place
        REQUIRE(recentFiles().size() == 2);
        CHECK(recentFiles()[0].name == "second.nrrd");
        CHECK_FALSE(recentFiles()[1].pictureFile.isEmpty());
        w.services().store().setClean();
        w.window.close();
    }
    const std::vector<RecentFile> files = recentFiles();
    REQUIRE(files.size() == 2);
    for (const RecentFile& file : files) {
        INFO(file.name.toStdString());
        const QImage picture(file.pictureFile);
        CHECK(picture.size() == kRecentPicture);
        // Data: for nobody else.
        CHECK((QFileInfo(file.pictureFile).permissions() & (QFile::ReadGroup | QFile::ReadOther)) == 0);
    }
    // It is the picture that was left: its middle, in the shape of 4 to 3.
    const QImage filled = left.scaled(kRecentPicture, Qt::KeepAspectRatioByExpanding, Qt::SmoothTransformation);
    const QImage middle = filled.copy(
        QRect(QPoint((filled.width() - kRecentPicture.width()) / 2, (filled.height() - kRecentPicture.height()) / 2),
              kRecentPicture));
    CHECK(meanDifference(QImage(files[1].pictureFile), middle) < 3);
    CHECK(meanDifference(QImage(files[0].pictureFile), middle) > 3); // the other view is another picture

    // Fewer files, fewer pictures; then none at all.
    Preferences fewer;
    fewer.recentCount = 1;
    keepPreferences(fewer);
    trimRecent();
    CHECK(recentFiles().size() == 1);
    CHECK_FALSE(QFileInfo::exists(files[1].pictureFile));
    CHECK(QFileInfo::exists(files[0].pictureFile));
    fewer.recentPictures = false;
    keepPreferences(fewer);
    trimRecent();
    CHECK(recentFiles().size() == 1);
    CHECK_FALSE(QFileInfo::exists(files[0].pictureFile));
}

TEST_CASE("recent files are offered in the menu and at the start, and missing ones say why", "[preferences][recent]") {
    const PlainPreferences plain;
    QSettings().setValue("welcomeCardSeen", true);
    const QTemporaryDir folder;
    const QString kept = writtenBoxes(folder, "kept.nrrd"), lost = writtenBoxes(folder, "lost.nrrd");
    {
        OpenWindow w;
        openFile(w, lost);
        openFile(w, kept);
        w.services().store().setClean();
        w.window.close();
    }
    REQUIRE(QFile::remove(lost));
    OpenWindow w;
    QMenu& menu = *w.services().actions().menu("&File/Open &recent");
    REQUIRE(menu.actions().size() == 4); // two files, a line, Clear
    CHECK(menu.actions()[0]->text() == "kept.nrrd");
    CHECK(menu.actions()[0]->isEnabled());
    CHECK(menu.actions()[0]->icon().availableSizes().contains(kRecentPicture));
    CHECK(menu.actions()[1]->text() == "lost.nrrd – missing");
    CHECK_FALSE(menu.actions()[1]->isEnabled());
    CHECK(menu.actions()[1]->toolTip() == lost + ": it is not there any more");

    w.window.welcome();
    auto& card = w.child<WelcomeCard>("welcomeCard");
    const auto tiles = card.findChildren<QToolButton*>("welcomeRecent");
    REQUIRE(tiles.size() == 2);
    CHECK(card.findChild<QLabel*>("welcomeTitle") == nullptr); // what to try has been seen
    CHECK(tiles[0]->accessibleName() == "kept.nrrd, in " + folder.path());
    CHECK(tiles[0]->text().startsWith("kept.nrrd\n"));
    CHECK_FALSE(tiles[1]->isEnabled());
    CHECK(tiles[1]->toolTip().endsWith("it is not there any more"));
    // By the keyboard: the card goes when the file is open.
    w.window.activateWindow();
    tiles[0]->setFocus();
    QTest::keyClick(tiles[0], Qt::Key_Space);
    REQUIRE(waitFor([&] { return w.document().volume()->title == "kept.nrrd"; }));
    REQUIRE(waitFor([&] { return w.window.findChild<WelcomeCard*>() == nullptr; }));
    w.settle();
    w.services().store().setClean();

    w.child<QAction>("clearRecentAction").trigger();
    CHECK(recentFiles().empty());
    CHECK_FALSE(menu.isEnabled());
    w.window.welcome(); // nothing to say
    CHECK(w.window.findChild<WelcomeCard*>() == nullptr);
}

TEST_CASE("a session that is saved becomes a recent file with a picture", "[preferences][recent]") {
    const PlainPreferences plain;
    const QTemporaryDir folder;
    OpenWindow w;
    const QString path = folder.filePath("scene.pellucid.json");
    REQUIRE(w.saving().saveSession(path));
    REQUIRE(recentFiles().size() == 1);
    CHECK(recentFiles()[0].path == path);
    CHECK(QImage(recentFiles()[0].pictureFile).size() == kRecentPicture);
}

TEST_CASE("Edit, Preferences opens them, and the status line tells the memory", "[preferences]") {
    const PlainPreferences plain;
    OpenWindow w;
    auto& memory = w.child<QLabel>("memoryLabel");
    CHECK_FALSE(memory.isVisible()); // pictures of the window are the same on every machine
    w.window.watchMemory();
    CHECK(memory.isVisible());
    CHECK(memory.text().contains(QRegularExpression("^[0-9.]+ of [0-9.]+ GiB$")));
    CHECK(memory.toolTip().contains("GiB"));
    bool looked = false;
    QTimer::singleShot(0, &w.window, [&] {
        auto* dialog = w.window.findChild<PreferencesDialog*>();
        if (dialog == nullptr) return;
        looked = true;
        auto& box = *dialog->findChild<QDoubleSpinBox*>("preferencesMemoryGiB");
        box.selectAll();
        QTest::keyClicks(&box, "700");
        QTest::keyClick(&box, Qt::Key_Return);
        CHECK(memory.text().contains(QRegularExpression(" of 700.0 GiB$"))); // used and left are the limit
        QTest::keyClick(dialog, Qt::Key_Escape);
    });
    w.child<QAction>("preferencesAction").trigger();
    CHECK(looked);
    CHECK(w.child<QAction>("preferencesAction").shortcut() == QKeySequence("Ctrl+Alt+,"));
}
