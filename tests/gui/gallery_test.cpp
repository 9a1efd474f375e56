// The gallery of presets: pictures of this volume, one click to use them, and presets of one's own.
#include "gui_support.h"

#include <QComboBox>
#include <QDir>
#include <QDockWidget>
#include <QInputDialog>
#include <QListWidget>
#include <QTimer>
#include <QToolButton>

#include "panels/gallery_panel.h"
#include "tf/presets.h"
#include "tf/tf_range.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct OpenGallery : OpenWindow {
    OpenGallery() {
        QDir(GalleryPanel::presetFolder()).removeRecursively();
        auto* dock = window.findChild<QDockWidget*>("galleryDock");
        REQUIRE(dock != nullptr);
        dock->show();
        dock->raise();
        settle();
    }
    ~OpenGallery() { QDir(GalleryPanel::presetFolder()).removeRecursively(); }
    QListWidget& list() { return child<QListWidget>("galleryList"); }
    QImage iconOf(int row) {
        return list().item(row)->icon().pixmap(list().iconSize()).toImage().convertToFormat(QImage::Format_RGB32);
    }
    int rowOf(const QString& title) {
        const auto found = list().findItems(title, Qt::MatchExactly);
        REQUIRE(found.size() == 1);
        return list().row(found.front());
    }
    void click(const QString& title) {
        QListWidgetItem* item = list().item(rowOf(title));
        list().scrollToItem(item);
        QTest::mouseClick(list().viewport(), Qt::LeftButton, {}, list().visualItemRect(item).center());
    }
};

/// A picture that is one colour all over has nothing in it.
bool isPlain(const QImage& image) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.pixel(x, y) != image.pixel(0, 0)) return false;
    return true;
}

} // namespace

TEST_CASE("the gallery draws every preset with this volume, and a click applies it", "[gui][gallery]") {
    OpenGallery g;
    const int layers = g.rowOf("Layers"), smoke = g.rowOf("Smoke");
    REQUIRE(waitFor([&] { return !isPlain(g.iconOf(layers)) && !isPlain(g.iconOf(smoke)); }));
    CHECK(g.iconOf(layers) != g.iconOf(smoke));

    const QImage before = g.picture();
    const TransferFunction old = g.document().tf();
    g.click("Layers");
    const ValueRange window = g.document().volume()->range();
    CHECK(rangeless(g.document().tf()) == rangeless(inRange(*tfFromPresetSpec("preset:sim-layers"), window)));
    CHECK(g.picture() != before);
    g.document().undo();
    CHECK(rangeless(g.document().tf()) == rangeless(old));
    CHECK(g.picture() == before);
}

TEST_CASE("of a preset the colours alone can be taken", "[gui][gallery]") {
    OpenGallery g;
    const TransferFunction old = g.document().tf();
    const QImage before = g.picture();
    g.child<QComboBox>("galleryTake").setCurrentIndex(1);
    g.click("Layers");
    const TransferFunction now = g.document().tf();
    REQUIRE(now.points.size() == old.points.size());
    for (std::size_t i = 0; i < now.points.size(); ++i) {
        CHECK(now.points[i].opacity == old.points[i].opacity);
        CHECK(now.points[i].x == old.points[i].x);
    }
    CHECK_FALSE(now == old);
    CHECK(g.picture() != before);
}

TEST_CASE("a transfer function is kept as a preset of one's own, with its opacities", "[gui][gallery]") {
    OpenGallery g;
    g.document().setTf(tents(2, 0.21), "mine");
    const int before = g.list().count();
    QTimer::singleShot(0, [&] {
        REQUIRE(waitFor([] { return QApplication::activeModalWidget() != nullptr; }));
        auto* dialog = qobject_cast<QInputDialog*>(QApplication::activeModalWidget());
        REQUIRE(dialog != nullptr);
        dialog->setTextValue("Two of mine");
        dialog->accept();
    });
    g.child<QToolButton>("galleryKeep").click();
    REQUIRE(g.list().count() == before + 1);
    const QImage kept = g.picture();

    g.click("3 tents");
    CHECK(g.document().tf().features.size() == 3);
    CHECK(g.picture() != kept);
    g.click("Two of mine");
    CHECK(featureOpacities(g.document().tf()) == std::vector{0.21, 0.21});
    CHECK(g.picture() == kept);

    g.list().setCurrentRow(g.rowOf("Two of mine"));
    g.child<QToolButton>("galleryRemove").click();
    CHECK(g.list().count() == before);
}
