// The sphere of views: what it shows, a look by pointing at it, a way by a click, and the best view.
#include "gui_support.h"

#include <QAbstractButton>
#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QGroupBox>
#include <QHelpEvent>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QTableView>
#include <QToolTip>

#include <glm/geometric.hpp>

#include "controllers/view_search_controller.h"
#include "optimize/answer/visibility_words.h"
#include "render/view_direction.h"
#include "view/view_globe.h"
#include "widgets/terms.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct OpenGlobe : OpenWindow {
    OpenGlobe() {
        child<QAction>("viewsAction").trigger();
        REQUIRE_FALSE(child<QDockWidget>("viewsDock").isHidden());
        found();
    }
    ViewSearchController& search() { return controllers().views; }
    ViewGlobe& globe() { return child<ViewGlobe>("viewGlobe"); }
    QString words() { return child<QLabel>("viewsWords").text(); }
    QPushButton& button(const char* name) { return child<QPushButton>(name); }
    /// By itself, since the panel is open.
    void found() {
        REQUIRE(waitFor([this] { return !search().isBusy() && search().isCurrent() && search().best().has_value(); }));
        settle();
    }
    QImage globePicture() { return globe().grab().toImage().convertToFormat(QImage::Format_RGB32); }
    QColor seenAt(const Vec3& direction) {
        const auto point = globe().pointOf(direction);
        REQUIRE(point);
        return globePicture().pixelColor(point->toPoint());
    }
    void point(const QPointF& at) {
        QMouseEvent event(QEvent::MouseMove, at, globe().mapToGlobal(at), Qt::NoButton, Qt::NoButton, {});
        QCoreApplication::sendEvent(&globe(), &event);
    }
    void leave() {
        QEvent event(QEvent::Leave);
        QCoreApplication::sendEvent(&globe(), &event);
    }
    /// A direction on the side that faces the eye, to the right of it and above.
    Vec3 upperRight() {
        const Camera& c = document().camera();
        return glm::normalize(-c.forward() + 0.6 * c.right() + 0.4 * c.trueUp());
    }
};

/// Of `a`; the words below the globe may take it a line of its height.
int differentPixels(const QImage& a, const QImage& other) {
    const QImage b = other.scaled(a.size());
    int different = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QColor p = a.pixelColor(x, y), q = b.pixelColor(x, y);
            different +=
                std::abs(p.red() - q.red()) + std::abs(p.green() - q.green()) + std::abs(p.blue() - q.blue()) > 24;
        }
    return different;
}

} // namespace

TEST_CASE("the globe is coloured by the figure of each view, and turns with the picture", "[gui][views]") {
    OpenGlobe w;
    const ViewMap& map = w.search().map();
    REQUIRE(map.values.size() == kSphereViews);
    REQUIRE(map.metric.figure == ViewMetric::Figure::Objective);
    // The directions of the near side, away from letters and marks, have the colours of their values, darker toward
    // the rim by a fifth at most.
    const QImage picture = w.globePicture();
    int alike = 0, looked = 0;
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        const auto at = w.globe().pointOf(map.directions[i]);
        if (!at || glm::dot(map.directions[i], w.document().camera().forward()) > -0.4) continue;
        const QColor seen = picture.pixelColor(at->toPoint()), meant = w.globe().colorOf(map.values[i]);
        const auto fits = [](int s, int m) { return s <= m + 12 && s >= 0.8 * m - 12; };
        alike += fits(seen.red(), meant.red()) && fits(seen.green(), meant.green()) && fits(seen.blue(), meant.blue());
        ++looked;
    }
    REQUIRE(looked > 50);
    CHECK(alike > 0.8 * looked);
    // What faces the eye is where it looks from, also after a turn.
    const auto facing = [&] { return *w.globe().directionAt(*w.globe().pointOf(-w.document().camera().forward())); };
    CHECK(glm::length(facing() + w.document().camera().forward()) < 1e-6);
    w.document().setCamera(rotated(w.document().camera(), w.document().volume()->geometry(), 70, 20));
    w.settle();
    CHECK(glm::length(facing() + w.document().camera().forward()) < 1e-6);
    CHECK(differentPixels(picture, w.globePicture()) > 100);
    CHECK(w.search().isCurrent()); // turning changes no map
    CHECK(w.words().contains("Best: azimuth"));
}

TEST_CASE("pointing at the globe looks from there and changes nothing", "[gui][views]") {
    OpenGlobe w;
    const Camera camera = w.document().camera();
    const QImage before = w.picture();
    const Vec3 direction = w.upperRight();
    w.point(*w.globe().pointOf(direction));
    const QImage glimpse = w.picture();
    CHECK(differentPixels(before, glimpse) > 200);
    CHECK(w.document().camera() == camera);
    CHECK_FALSE(w.services().store().canUndoCamera());
    CHECK(w.document().stepCount() == 0);
    w.leave();
    CHECK(differentPixels(before, w.picture()) == 0);

    // It is the picture that a click leads to.
    QTest::mouseClick(&w.globe(), Qt::LeftButton, {}, w.globe().pointOf(direction)->toPoint());
    CHECK(glm::length(-w.document().camera().forward() - direction) < 0.05);
    CHECK(w.document().camera().projection == camera.projection);
    CHECK(w.services().store().canUndoCamera());
    CHECK(w.document().stepCount() == 0);
    w.point({-50, -50}); // beside the sphere: it is the camera that stays
    const QImage after = w.picture();
    CHECK(differentPixels(before, after) > 200);
    CHECK(differentPixels(glimpse, after) < differentPixels(glimpse, before));
    w.services().store().undoCamera();
    CHECK(w.document().camera() == camera);
    CHECK(differentPixels(before, w.picture()) == 0);
}

TEST_CASE("a drag on the globe turns the view in one step", "[gui][views]") {
    OpenGlobe w;
    const Camera camera = w.document().camera();
    const QImage before = w.picture();
    const QPointF middle = *w.globe().pointOf(-camera.forward());
    drag(w.globe(), middle, middle + QPointF(40, 0));
    CHECK_FALSE(w.document().camera() == camera);
    // To the right: the volume follows the hand, so that the eye goes to the left.
    CHECK(glm::dot(w.document().camera().forward(), camera.right()) > 0.2);
    CHECK(differentPixels(before, w.picture()) > 200);
    w.services().store().undoCamera();
    CHECK(w.document().camera() == camera);
}

TEST_CASE("the best view is gone to, and is the best", "[gui][views]") {
    OpenGlobe w;
    const Camera camera = w.document().camera();
    const QImage before = w.picture();
    const BestView best = *w.search().best();
    CHECK(best.best.value <= best.present.value); // F
    CHECK(best.present.camera == camera);
    w.settle();
    // The figure is the one that the bars have.
    CHECK(best.present.value == Approx(*w.services().results().objective()).margin(1e-6));
    w.button("viewsGo").click();
    CHECK(w.document().camera() == best.best.camera);
    w.settle();
    CHECK(*w.services().results().objective() == Approx(best.best.value).margin(1e-6));
    if (!(best.best.camera == camera)) CHECK(differentPixels(before, w.picture()) > 100);
    CHECK(w.search().isCurrent());

    // Of a feature: more is better.
    auto& figure = w.child<QComboBox>("viewsFigure");
    REQUIRE(figure.count() == 4);
    const QImage globe = w.globePicture();
    figure.setCurrentIndex(2);
    Q_EMIT figure.activated(2);
    w.found();
    CHECK(w.search().map().metric.figure == ViewMetric::Figure::Vws);
    CHECK(w.search().map().metric.feature == 1);
    CHECK(w.search().best()->best.value >= w.search().best()->present.value);
    CHECK(w.words().contains("Attention = "));
    CHECK(differentPixels(globe, w.globePicture()) > 100);
}

TEST_CASE("globe and panel have the same figure of this view, and say what is of a coarser copy", "[gui][views]") {
    OpenGlobe w;
    w.document().setCamera(rotated(w.document().camera(), w.document().volume()->geometry(), 25, 10));
    w.settle();
    REQUIRE_FALSE(w.document().camera() == w.search().best()->best.camera);
    const double objective = *w.services().results().objective();
    const QString figure = QString::fromStdString(offTargetText(objective));
    INFO(w.words().toStdString());
    CHECK(w.child<QLabel>("distanceLabel").text().compare(figure, Qt::CaseInsensitive) == 0);
    CHECK(w.words().endsWith("From here: " + figure + "."));
    // Of a place that nobody has measured on the volume.
    const QPointF at = *w.globe().pointOf(w.upperRight());
    QHelpEvent help(QEvent::ToolTip, at.toPoint(), w.globe().mapToGlobal(at.toPoint()));
    QCoreApplication::sendEvent(&w.globe(), &help);
    INFO(QToolTip::text().toStdString());
    CHECK(QToolTip::text().contains("about off target by "));
    CHECK(QToolTip::text().contains("on a coarser copy of the volume"));
    QToolTip::hideText();
    // The share of a feature, likewise.
    auto& box = w.child<QComboBox>("viewsFigure");
    box.setCurrentIndex(2);
    Q_EMIT box.activated(2);
    w.found();
    const double vws = w.document().measures()->features[1].vws;
    CHECK(w.words().endsWith(QStringLiteral("Attention = %1.").arg(vws, 0, 'f', 4)));
}

TEST_CASE("figures have plain names, and scientific ones where these are chosen", "[gui][words]") {
    OpenGlobe w;
    const double objective = *w.services().results().objective();
    auto& table = w.child<QTableView>("featuresTable");
    const auto header = [&](int column) {
        return table.model()->headerData(column, Qt::Horizontal, Qt::DisplayRole).toString();
    };
    CHECK(header(FeaturesModel::Vws) == "Attention");
    CHECK(header(FeaturesModel::Visibility) == "Seen");
    CHECK(w.child<QLabel>("distanceLabel").text().startsWith("Off target by "));
    w.child<QCheckBox>("scientificNamesCheck").click();
    CHECK(header(FeaturesModel::Vws) == "VWS");
    CHECK(header(FeaturesModel::Visibility) == "Visibility");
    CHECK(w.child<QLabel>("distanceLabel").text() == QStringLiteral("F = %1").arg(objective, 0, 'f', 4));
    CHECK(w.words().contains("F = "));
    w.child<QCheckBox>("scientificNamesCheck").click();
    CHECK(header(FeaturesModel::Vws) == "Attention");
    // The published profile has no other names.
    w.document().store().edit("published", {}, [](Session& session) {
        session.measure.edit([](MeasureSettings& m) { m.profile = Profile::Published; });
    });
    CHECK(header(FeaturesModel::Vws) == "VWS");
    CHECK_FALSE(w.child<QCheckBox>("scientificNamesCheck").isEnabled());
    w.services().undo();
    CHECK(header(FeaturesModel::Vws) == "Attention");
}

namespace {

/// What a window's widgets show, tooltips apart.
QStringList textsOf(const QWidget& window) {
    QStringList all;
    for (const auto* label : window.findChildren<QLabel*>()) all << label->text();
    for (const auto* button : window.findChildren<QAbstractButton*>()) all << button->text();
    for (const auto* action : window.findChildren<QAction*>()) all << action->text();
    for (const auto* box : window.findChildren<QGroupBox*>()) all << box->title();
    for (const auto* dock : window.findChildren<QDockWidget*>()) all << dock->windowTitle();
    for (const auto* choice : window.findChildren<QComboBox*>())
        for (int i = 0; i < choice->count(); ++i) all << choice->itemText(i);
    for (const auto* view : window.findChildren<QTableView*>())
        for (int i = 0; view->model() != nullptr && i < view->model()->columnCount(); ++i)
            all << view->model()->headerData(i, Qt::Horizontal, Qt::DisplayRole).toString();
    return all;
}

} // namespace

TEST_CASE("no widget has a scientific name unless one wants them", "[gui][words]") {
    OpenGlobe w;
    for (auto* dock : w.window.findChildren<QDockWidget*>()) dock->show();
    QApplication::processEvents();
    static const QRegularExpression scientific("\\bVWS\\b|\\bF = |\\bFV\\b|\\balpha\\b|\\biterations?\\b");
    const QStringList texts = textsOf(w.window);
    CHECK(texts.size() > 300);
    for (const QString& text : texts) {
        INFO(text.toStdString());
        CHECK_FALSE((text.contains(scientific)));
    }
    terms().choose(true);
    CHECK(textsOf(w.window).filter(QRegularExpression("\\bVWS\\b")).size() >= 2);
    terms().choose(false);
}

TEST_CASE("a globe of an older state is pale until it is made anew", "[gui][views]") {
    OpenGlobe w;
    const std::vector<double> values = w.search().map().values;
    const QImage current = w.globePicture();
    w.search().setWanted(false); // as where the panel is closed: nothing begins by itself
    w.document().setTargets({0.7, 0.2, 0.1});
    CHECK_FALSE(w.search().isCurrent());
    CHECK(w.words().contains("earlier state"));
    CHECK_FALSE(w.button("viewsGo").isEnabled());
    const QImage pale = w.globePicture();
    CHECK(differentPixels(current, pale) > 1000);
    w.document().undo(); // the figures of this state are still there
    CHECK(w.search().isCurrent());
    CHECK(differentPixels(current, w.globePicture()) == 0);

    w.document().setTargets({0.7, 0.2, 0.1});
    w.search().setWanted(true);
    w.found();
    CHECK(w.search().map().values != values);
    CHECK(w.button("viewsGo").isEnabled());

    // Going nearer is another sphere of views, in a perspective.
    w.document().setCamera(zoomed(w.document().camera(), w.document().volume()->geometry(), 0.6));
    CHECK_FALSE(w.search().isCurrent());
    w.found();
}

TEST_CASE("a search of views can be stopped, and is not begun again", "[gui][views]") {
    OpenGlobe w;
    VolumeSource source;
    source.path = "sample:knee";
    source.sampleSize = 96;
    w.open(source);
    w.settle();
    w.document().setTargets(std::vector<double>(w.document().tf().features.size(), 1.0));
    w.search().start();
    REQUIRE(w.search().isRunning());
    const QImage running = w.window.grab().toImage();
    CHECK(w.button("viewsLook").text() == "Stop");
    w.button("viewsLook").click();
    CHECK_FALSE(w.search().isRunning());
    CHECK_FALSE(w.search().isCurrent());
    CHECK_FALSE(w.button("viewsGo").isEnabled());
    QTest::qWait(900); // longer than a hand must rest
    CHECK_FALSE(w.search().isBusy());
    CHECK(differentPixels(running, w.window.grab().toImage()) > 10); // the button says something else
    w.button("viewsLook").click();
    w.found();
}

TEST_CASE("view and opacities are optimized together, one step of each history", "[gui][views]") {
    OpenGlobe w;
    const Camera camera = w.document().camera();
    const TransferFunction tf = w.document().tf();
    const double before = *w.services().results().objective();
    const int steps = w.document().stepCount();
    const QImage picture = w.picture();
    w.child<QAction>("optimizeViewAction").trigger();
    REQUIRE(w.search().isOptimizing());
    REQUIRE(waitFor([&] { return !w.search().isOptimizing(); }));
    w.settle();
    CHECK(*w.services().results().objective() < before);
    CHECK(w.document().stepCount() == steps + 1);
    CHECK(w.services().store().session().runs->size() == 1);
    CHECK(w.optimizing().message().contains("azimuth"));
    CHECK(differentPixels(picture, w.picture()) > 100);
    w.document().undo();
    CHECK(w.document().tf() == tf);
    if (w.services().store().canUndoCamera()) w.services().store().undoCamera();
    CHECK(w.document().camera() == camera);

    // Cancelled it leaves no trace.
    w.child<QAction>("optimizeViewAction").trigger();
    REQUIRE(w.search().isOptimizing());
    w.search().cancelOptimizing();
    w.settle();
    CHECK(w.document().tf() == tf);
    CHECK(w.document().camera() == camera);
}
