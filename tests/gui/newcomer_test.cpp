// What someone who knows 3D Slicer does on the first day, without the guide: an own CT, the skull lit through the skin,
// more of the vessels, less of the head rest, a distance, a film. Everything is done by events on what is seen, found
// by its label, and every one of them counts.
#include "gui_support.h"

#include <cmath>

#include <QAction>
#include <QDialog>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMenuBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTabBar>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolBar>
#include <QToolButton>

#include <glm/geometric.hpp>

#include "dialogs/film_dialog.h"
#include "panels/probe_plot.h"
#include "render/clip_handles.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

constexpr int kSide = 64;      // voxels
constexpr double kVoxel = 3.5; // mm

/// Of a vessel that runs up the head, 12 mm below its skin at the patient's front: x and y in mm.
constexpr double kVesselX = 20, kVesselY = -66, kVesselRadius = 7;

double partOf(double distance) { return std::clamp(0.5 - distance / kVoxel, 0.0, 1.0); } // of a voxel, inside a surface

/// A made-up head of a CT, in Hounsfield units, on a board from border to border. LPS, the middle at 0.
double headAt(const Vec3& p) {
    const auto ellipsoid = [&](double x, double y, double z) {
        return (glm::length(p / Vec3(x, y, z)) - 1) * std::min(x, y);
    };
    double value = -1000;
    const auto cover = [&](double distance, double hu) { value = std::lerp(value, hu, partOf(distance)); };
    cover(ellipsoid(72, 88, 100), 40); // skin and flesh
    cover(ellipsoid(54, 62, 82), 900); // skull
    cover(ellipsoid(47, 55, 75), 35);  // brain
    cover(std::max(glm::length(Vec3(p.x - kVesselX, p.y - kVesselY, 0)) - kVesselRadius, ellipsoid(68, 84, 96)), 300);
    cover(std::max(std::abs(p.y - 98) - 4, std::abs(p.x) - 80), 150); // board
    return value + 3 * std::sin(p.x * 1.7 + p.y * 2.3 + p.z * 3.1);
}

/// A patient's, as scanners write it.
void writeHead(const QString& path) {
    Geometry g{Int3(kSide), Vec3(kVoxel), Vec3(-0.5 * kVoxel * (kSide - 1)), Mat3(1), WorldAxes::Patient};
    Grid<float> values(g.dims);
    std::size_t i = 0;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) values[i++] = static_cast<float>(headAt(g.worldFromVoxel(Vec3(x, y, z))));
    writeNrrd(g, values, path.toStdString());
}

QString plain(QString text) { return text.remove('&').remove(QChar(0x2026)).trimmed(); }

/// A hand that finds what it presses by what is written there, and counts. A choice in a menu is one action, and so is
/// what is typed into a field.
class Hand {
public:
    explicit Hand(OpenWindow& w) : m_w(w) {}
    int actions() const { return m_actions; }
    const QStringList& labels() const { return m_labels; }

    /// "File", "Save film": both are there and can be chosen.
    void choose(const QString& menu, const QString& row) {
        QAction* found = nullptr;
        for (QAction* top : m_w.window.menuBar()->actions())
            if (plain(top->text()) == menu)
                for (QAction* action : top->menu()->actions())
                    if (plain(action->text()) == row) found = action;
        INFO((menu + " → " + row).toStdString());
        REQUIRE(found != nullptr);
        REQUIRE(found->isEnabled());
        did(menu + " → " + row);
        found->trigger();
    }
    void press(const QString& text, QWidget* in = nullptr) {
        for (auto* button : (in != nullptr ? in : &m_w.window)->findChildren<QAbstractButton*>())
            if (button->isVisible() && plain(button->text()) == text) {
                INFO(text.toStdString());
                REQUIRE(button->isEnabled());
                did(text);
                QTest::mouseClick(button, Qt::LeftButton);
                return;
            }
        FAIL("no button says " << text.toStdString());
    }
    void openTab(const QString& text) {
        for (auto* bar : m_w.window.findChildren<QTabBar*>())
            for (int i = 0; i < bar->count(); ++i)
                if (bar->isVisible() && plain(bar->tabText(i)) == text) {
                    did(text);
                    QTest::mouseClick(bar, Qt::LeftButton, {}, bar->tabRect(i).center());
                    return;
                }
        FAIL("no tab says " << text.toStdString());
    }
    void click(QListWidget& list, const QString& text) {
        const auto found = list.findItems(text, Qt::MatchExactly);
        REQUIRE(found.size() == 1);
        list.scrollToItem(found.front());
        did(text);
        QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(found.front()).center());
    }
    void clickAt(QWidget& widget, const QPointF& at, const QString& what) {
        did(what);
        QTest::mouseMove(&widget, at.toPoint());
        QTest::mouseClick(&widget, Qt::LeftButton, {}, at.toPoint());
    }
    /// What is done in the dialog that opens next; each counts by itself.
    template <class Dialog>
    void inDialog(const std::function<void(Dialog&)>& work) {
        QTimer::singleShot(0, [work] {
            REQUIRE(waitFor([] { return qobject_cast<Dialog*>(QApplication::activeModalWidget()) != nullptr; }));
            work(*qobject_cast<Dialog*>(QApplication::activeModalWidget()));
        });
    }
    void did(const QString& label) {
        ++m_actions;
        m_labels << label;
    }

private:
    OpenWindow& m_w;
    int m_actions = 0;
    QStringList m_labels;
};

/// Where a place of the world appears in the view.
QPointF seenAt(OpenWindow& w, const Vec3& world) {
    const auto at = pixelOf({w.services().scene().camera, w.view().width(), w.view().height()}, world);
    REQUIRE(at);
    return {at->x, at->y};
}

double shareOf(const Document& document, const char* feature) {
    const auto& features = document.tf().features;
    for (std::size_t f = 0; f < features.size(); ++f)
        if (features[f].name == feature) return document.measures()->features[f].visibility;
    FAIL("no feature is called " << feature);
    return 0;
}

} // namespace

TEST_CASE("a newcomer comes from an own CT to a film in fourteen actions", "[gui][newcomer]") {
    const QTemporaryDir folder;
    writeHead(folder.filePath("head.nrrd"));
    OpenWindow w;
    w.window.resize(1280, 800);
    w.settle();
    Hand hand(w);
    QString said; // the latest message of the window
    QObject::connect(&w.services(), &Services::message, &w.window, [&said](const QString& text) { said = text; });

    // Start → own CT.
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    hand.inDialog<QFileDialog>([&](QFileDialog& dialog) {
        dialog.findChild<QLineEdit*>("fileNameEdit")->setText(folder.filePath("head.nrrd"));
        hand.did("the name of the file");
        QMetaObject::invokeMethod(&dialog, "accept");
    });
    hand.choose("File", "Open");
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(w.services().scene().session.display->light.on);

    // Less of the head rest: it is found, and can be left out.
    hand.press("Leave out board");
    w.settle();
    CHECK_FALSE(w.services().scene().session.clipping->rest.isNone());
    CHECK(w.services().scene().session.clipping->rest.density == 0);

    // The skull lit through the skin, with the vessels.
    hand.openTab("Presets");
    w.settle();
    hand.click(w.child<QListWidget>("galleryList"), "Vessels");
    w.settle();
    const double skull = shareOf(w.document(), "bone"), skin = shareOf(w.document(), "skin");
    CHECK(skull > 0);
    CHECK(skin > 0);

    // More of the vessels: a click on one, and the button that says so.
    const double before = shareOf(w.document(), "vessels");
    hand.clickAt(w.view(), seenAt(w, {kVesselX, kVesselY, 0}), "the vessel in the picture");
    w.settle();
    auto& shares = w.child<ProbeShares>("probeShares");
    const std::vector<ProbeShares::Row> rows = shares.rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].feature >= 0 && rows[i].feature != w.controllers().probe.feature() &&
            w.document().tf().features[static_cast<std::size_t>(rows[i].feature)].name == "vessels")
            hand.clickAt(shares, shares.rowRect(static_cast<int>(i)).center(), "vessels");
    hand.press("More of this");
    w.settle();
    CHECK(shareOf(w.document(), "vessels") > before);

    // A distance is measured.
    hand.choose("Measure", "Distance");
    hand.clickAt(w.view(), seenAt(w, {-35, -40, 30}), "a point of the skull");
    hand.clickAt(w.view(), seenAt(w, {25, -45, -35}), "another one");
    w.settle();
    INFO(said.toStdString());
    REQUIRE(w.services().scene().session.rulers->size() == 1);
    const double length = *readGeometry(w.services().scene().session.rulers->front()).length;
    CHECK(length > 30);
    CHECK(length < 150);

    // A film is saved.
    QSignalSpy saved(&w.controllers().films, &FilmController::saved);
    hand.inDialog<FilmDialog>([&](FilmDialog& dialog) {
        // Small and short for the test; the user would leave them as they are.
        dialog.findChild<QSpinBox*>("filmWidth")->setValue(48);
        dialog.findChild<QSpinBox*>("filmHeight")->setValue(32);
        dialog.findChild<QDoubleSpinBox*>("filmSeconds")->setValue(1);
        dialog.findChild<QDoubleSpinBox*>("filmRate")->setValue(2);
        dialog.findChild<QLineEdit*>("filmPath")->setText(folder.filePath("film"));
        hand.did("the name of the film");
        hand.did("Save");
        dialog.accept();
    });
    hand.choose("File", "Save film");
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    CHECK(QFile::exists(folder.filePath("film/picture_00001.png")));

    INFO(hand.labels().join("; ").toStdString());
    CHECK(hand.actions() <= 14);
}
