// A click on the picture: what the ray meets there, and more or less of it.
#include "gui_support.h"

#include <numeric>

#include <QAction>
#include <QLabel>
#include <QPushButton>

#include "controllers/probe_controller.h"
#include "engines/engines.h"
#include "panels/probe_plot.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

ProbeController& probeOf(OpenWindow& w) { return w.controllers().probe; }

/// Press and release without a motion.
void click(QWidget& widget, const QPointF& at) {
    for (const QEvent::Type type : {QEvent::MouseButtonPress, QEvent::MouseButtonRelease}) {
        QMouseEvent event(type, at, widget.mapToGlobal(at), Qt::LeftButton,
                          type == QEvent::MouseButtonPress ? Qt::LeftButton : Qt::NoButton, {});
        QCoreApplication::sendEvent(&widget, &event);
    }
}

QPointF middle(OpenWindow& w) { return {w.view().width() / 2 + 0.0, w.view().height() / 2 + 0.0}; }

/// Alpha of the picture as the cpu draws it where the view has been clicked on.
double alphaOfPicture(OpenWindow& w, const QPointF& at) {
    PictureInput picture = pictureInput(w.services().scene(), w.view().width(), w.view().height(), true);
    picture.settings.stepInD0 = 1.0 / 16;
    const Image image =
        makeRenderer(EngineChoice::Cpu, picture.volume)->render(picture.camera, picture.tf, picture.settings);
    return static_cast<double>(image.pixel(static_cast<int>(at.x()), static_cast<int>(at.y()))[3]);
}

double sumOf(const RayProbe& ray) { return std::accumulate(ray.shares.begin(), ray.shares.end(), ray.rest); }

/// What the rows of the panel say, in per cent.
double sumOfRows(OpenWindow& w) {
    double sum = 0;
    for (const ProbeShares::Row& row : w.child<ProbeShares>("probeShares").rows())
        sum += QString(row.text).remove(" %").toDouble();
    return sum;
}

/// Pixels that differ by more than the mark and the panel cover: those of the picture itself.
QImage pictureAlone(OpenWindow& w) {
    w.settle();
    const PictureInput picture = pictureInput(w.services().scene(), 64, 48);
    const Image image =
        makeRenderer(EngineChoice::Cpu, picture.volume)->render(picture.camera, picture.tf, picture.settings);
    QImage copy(64, 48, QImage::Format_RGB32);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            copy.setPixelColor(x, y,
                               QColor::fromRgbF(image.pixel(x, y)[0], image.pixel(x, y)[1], image.pixel(x, y)[2]));
    return copy;
}

} // namespace

TEST_CASE("a click tells what the ray meets, and its shares are the pixel's alpha", "[probe]") {
    OpenWindow w(32);
    const auto& panel = w.child<QFrame>("probePanel");
    CHECK(panel.isHidden());
    for (const QPointF& way : {QPointF(0, 0), QPointF(40, 15), QPointF(-60, -30), QPointF(10, 90)}) {
        const QPointF at = middle(w) + way;
        probeOf(w).clear();
        const QImage before = w.picture();
        click(w.view(), at);
        REQUIRE(panel.isVisible());
        const RayProbe& ray = probeOf(w).ray();
        CHECK(std::abs(sumOf(ray) - alphaOfPicture(w, at)) < 1.0 / 255);
        // Each row is rounded to a tenth.
        CHECK(std::abs(sumOfRows(w) / 100 - ray.alpha) < 0.0005 * static_cast<double>(ray.shares.size() + 1));
        const Feature& main = w.document().tf().features[static_cast<std::size_t>(ray.feature)];
        CHECK(w.services().selection().feature() == main.id);
        CHECK(w.child<QLabel>("probeTitle").text().startsWith(QString::fromStdString(main.name)));
        CHECK(w.child<QLabel>("probeText").text().contains(QString::number(100 * ray.alpha, 'f', 1)));
        CHECK(w.picture() != before); // the ring, and the panel
    }
    // Clicks are no edits, and the view stays.
    CHECK(w.document().stepCount() == 0);
}

TEST_CASE("a click beside the volume, Esc and other data end the probe", "[probe]") {
    OpenWindow w;
    const auto& panel = w.child<QFrame>("probePanel");
    const QImage before = w.picture();
    click(w.view(), middle(w));
    CHECK(panel.isVisible());
    click(w.view(), {3, w.view().height() - 3.0});
    CHECK(panel.isHidden());
    CHECK(w.picture() == before);
    click(w.view(), middle(w));
    QTest::keyClick(&w.view(), Qt::Key_Escape);
    CHECK(panel.isHidden());
    CHECK_FALSE(probeOf(w).isActive());
    click(w.view(), middle(w));
    drag(w.view(), middle(w), middle(w) + QPointF(30, 0)); // a drag is no click: the probe stays
    CHECK(panel.isVisible());
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 16;
    w.opening().openVolume(source, "tents:3");
    w.settle();
    CHECK(panel.isHidden());
}

TEST_CASE("more of this and less of this change the transfer function and the picture", "[probe]") {
    OpenWindow w(32);
    const QPointF at = middle(w);
    click(w.view(), at);
    ProbeController& probe = probeOf(w);
    // The core lies behind two shells.
    const auto& shares = w.child<ProbeShares>("probeShares");
    const auto rows = shares.rows();
    REQUIRE(rows.size() >= 3);
    int core = -1;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].feature == 2) core = static_cast<int>(i);
    REQUIRE(core >= 0);
    click(w.child<ProbeShares>("probeShares"), shares.rowRect(core).center());
    REQUIRE(probe.feature() == 2);
    CHECK(w.services().selection().feature() == w.document().tf().features[2].id);

    const TransferFunction start = w.document().tf();
    const QImage picture = pictureAlone(w);
    const double share = probe.ray().shares[2], visible = w.document().measures()->features[2].visibility;
    QString said;
    QObject::connect(&w.services(), &Services::message, &w.window, [&said](const QString& text) { said = text; });
    QTest::mouseClick(&w.child<QPushButton>("moreOfThisButton"), Qt::LeftButton);
    CHECK(w.document().stepCount() == 1);
    const std::vector<double> before = featureOpacities(start), after = featureOpacities(w.document().tf());
    CHECK(after[2] > before[2]);
    CHECK(after[0] < before[0]);
    CHECK(after[1] < before[1]);
    CHECK(probe.ray().shares[2] > share + 0.02);
    CHECK(said.contains(QString::fromStdString(start.features[2].name) + QStringLiteral(" × ")));
    CHECK(said.contains(QString::fromStdString(start.features[0].name) + QStringLiteral(" ÷ ")));
    CHECK(pictureAlone(w) != picture);
    CHECK(w.document().measures()->features[2].visibility > visible);
    CHECK(std::abs(sumOf(probe.ray()) - alphaOfPicture(w, at)) < 1.0 / 255);

    w.document().undo();
    CHECK(w.document().tf() == start);
    CHECK(probe.ray().shares[2] == Approx(share).margin(1e-12));
    CHECK(pictureAlone(w) == picture);

    // Less of the outer shell, which nothing hides.
    w.services().selection().setFeature(start.features[0].id);
    const double outer = probe.ray().shares[0];
    QTest::mouseClick(&w.child<QPushButton>("lessOfThisButton"), Qt::LeftButton);
    CHECK(probe.ray().shares[0] < outer - 0.02);
    CHECK(featureOpacities(w.document().tf())[0] < before[0]);
    CHECK(featureOpacities(w.document().tf())[2] == before[2]);
    w.document().undo();

    // What is locked stays; the others give way.
    w.services().store().edit("Lock", {}, [&](Session& session) {
        session.goals.edit([&](FeatureGoals& goals) { goals[start.features[2].id].locked = true; });
    });
    w.services().selection().setFeature(start.features[2].id);
    w.child<QAction>("moreOfThisAction").trigger();
    CHECK(featureOpacities(w.document().tf())[2] == before[2]);
    CHECK(featureOpacities(w.document().tf())[0] < before[0]);
    CHECK_FALSE(said.contains(QString::fromStdString(start.features[2].name)));
}

TEST_CASE("the probe follows edits, clips and the camera", "[probe]") {
    OpenWindow w(32);
    click(w.view(), middle(w));
    ProbeController& probe = probeOf(w);
    const Vec3 place = probe.place();
    const double alpha = probe.ray().alpha;
    TransferFunction fainter = w.document().tf();
    for (ControlPoint& p : fainter.points) p.opacity *= 0.05;
    w.document().setTf(fainter, "Fainter");
    CHECK(probe.ray().alpha < alpha - 0.05);
    CHECK(std::abs(sumOf(probe.ray()) - alphaOfPicture(w, middle(w))) < 1.0 / 255);
    CHECK(sumOfRows(w) == Approx(100 * probe.ray().alpha).margin(0.3));

    // Turned, it is the ray of the pixel where the place is now.
    const Vec3 entry = probe.ray().entry;
    drag(w.view(), middle(w), middle(w) + QPointF(60, 20));
    CHECK(probe.place() == place);
    CHECK_FALSE(probe.ray().entry == entry);
    const Vec3 way = glm::normalize(probe.ray().exit - probe.ray().entry);
    const Vec3 off = place - probe.ray().entry - glm::dot(place - probe.ray().entry, way) * way;
    CHECK(glm::length(off) < 1e-6);

    const double left = probe.ray().alpha;
    w.services().store().edit("Clip", {},
                              [](Session& session) { session.clipping.edit([](Clipping& c) { c.hi.z = 0.6; }); });
    CHECK(probe.ray().alpha != left);
    // Nothing of the volume is left where it was.
    w.services().store().edit("Clip", {},
                              [](Session& session) { session.clipping.edit([](Clipping& c) { c.hi = Vec3(0.02); }); });
    CHECK_FALSE(probe.isActive());
}

TEST_CASE("slices beside the picture meet where it was probed", "[probe]") {
    OpenWindow w(32);
    w.services().store().edit("Layout", {}, [](Session& session) {
        session.slices.edit([](SliceViews& s) { s.layout = SliceViews::Layout::Four; });
    });
    w.settle();
    const int steps = w.document().stepCount();
    click(w.view(), middle(w));
    REQUIRE(probeOf(w).isActive());
    const Vec3 voxel = w.document().volume()->geometry().voxelFromWorld(probeOf(w).place());
    const auto crosshair = w.services().store().session().slices->crosshair;
    REQUIRE(crosshair);
    for (int a = 0; a < 3; ++a) CHECK(std::abs((*crosshair)[a] - voxel[a]) <= 0.5 + 1e-9);
    CHECK(w.document().stepCount() == steps);
    CHECK(std::abs(sumOf(probeOf(w).ray()) - alphaOfPicture(w, middle(w))) < 1.0 / 255);
}

TEST_CASE("the plot is read under the mouse", "[probe]") {
    OpenWindow w(32);
    click(w.view(), middle(w));
    auto& plot = w.child<ProbePlot>("probePlot");
    const RayProbe& ray = probeOf(w).ray();
    const auto move = [&](const QPointF& at) {
        QMouseEvent event(QEvent::MouseMove, at, plot.mapToGlobal(at), Qt::NoButton, Qt::NoButton, {});
        QCoreApplication::sendEvent(&plot, &event);
    };
    const QImage before = plot.grab().toImage();
    move({plot.xOf(ray.t), plot.plot().center().y()});
    // The sample nearest to where the main feature adds most: half of d0 apart, at most.
    REQUIRE(w.services().selection().hoveredIntensity());
    CHECK(*w.services().selection().hoveredIntensity() == Approx(ray.intensity).margin(0.1));
    CHECK(w.child<QLabel>("probeReadout").text().contains("depth"));
    CHECK(plot.grab().toImage() != before);
    QEvent leave(QEvent::Leave);
    QCoreApplication::sendEvent(&plot, &leave);
    CHECK_FALSE(w.services().selection().hoveredIntensity());
    // The area has the colours of the transfer function: the main feature's hue is in it.
    const QColor wanted = QColor::fromRgbF(static_cast<float>(ray.color.r), static_cast<float>(ray.color.g),
                                           static_cast<float>(ray.color.b));
    bool found = false;
    for (int x = 0; x < before.width(); ++x)
        for (int y = 0; y < before.height(); ++y) {
            const QColor c = before.pixelColor(x, y);
            found = found || (c.saturation() > 100 && std::abs(c.hue() - wanted.hue()) < 25);
        }
    CHECK(found);
}
