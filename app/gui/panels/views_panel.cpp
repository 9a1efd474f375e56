// The dock with the sphere of views.
#include <algorithm>

#include <QPushButton>
#include <QSignalBlocker>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "render/view_direction.h"
#include "services/services.h"
#include "view/camera_hand.h"
#include "view/view_globe.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kDegreesPerRadius = 60; ///< of a drag on the sphere: about what the surface under the mouse turns by

/// `about`: of the map, which is of a coarser copy of the volume.
QString figureText(const ViewMetric& metric, double value, bool about) {
    const QString figure =
        metric.figure == ViewMetric::Figure::Objective
            ? terms().offTarget(value)
            : QObject::tr("%1 = %2").arg(terms().attention(), QString::number(value, 'f', about ? 2 : 4));
    return about ? QObject::tr("about %1, on a coarser copy of the volume").arg(figure) : figure;
}

/// What is judged, the sphere in its colours, the best view in words, and the ways there.
class ViewsPanel : public QWidget {
public:
    ViewsPanel(Services& services, ViewSearchController& search, QWidget* parent);

private:
    void fillFigures();
    void refresh();
    QString words() const;
    std::optional<double> measuredHere(const ViewMetric& metric) const; ///< empty: not of the present state

    Services& m_services;
    ViewSearchController& m_search;
    QComboBox* m_figure =
        named(new QComboBox(this), "viewsFigure",
              tr("What a view is judged by: how far all features are from their targets (F, less is better),\n"
                 "or the attention on one feature (VWS, 0 to 1, more is better)"));
    ViewGlobe* m_globe = new ViewGlobe(this);
    QLabel* m_words = wrappedLabel("viewsWords", this);
    QProgressBar* m_progress = progressBar("viewsProgress", this);
    QPushButton* m_look = named(new QPushButton(this), "viewsLook");
    QPushButton* m_go = named(new QPushButton(tr("Go there"), this), "viewsGo",
                              tr("Moves the camera to the best view; Alt+Left comes back"));
    QPushButton* m_optimize = named(new QPushButton(this), "viewsOptimize",
                                    tr("The view and the opacities that together come nearest to the targets;\n"
                                       "opacities can be undone, and Alt+Left comes back to this view"));
    int m_gesture = 0;
};

ViewsPanel::ViewsPanel(Services& services, ViewSearchController& search, QWidget* parent)
    : QWidget(parent), m_services(services), m_search(search) {
    setObjectName("viewsPanel");
    m_figure->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_words->setTextInteractionFlags(Qt::TextSelectableByMouse);
    m_progress->setFixedHeight(6);
    QSizePolicy keptRoom = m_progress->sizePolicy(); // so that nothing moves where a search begins or ends
    keptRoom.setRetainSizeWhenHidden(true);
    m_progress->setSizePolicy(keptRoom);
    setLayout(inset(columnOf({m_figure, {m_globe, 1}, m_progress, m_words, rowOf({m_look, m_go}), m_optimize}),
                    {8, 8, 8, 8}));

    search.addActions();
    connect(&services.panels(), &Panels::visibilityChanged, &search, [&search](const QString& id, bool visible) {
        if (id == "views") search.setWanted(visible);
    });
    connect(m_figure, &QComboBox::activated, this,
            [this, &search](int row) { search.setFeature(m_figure->itemData(row).value<FeatureId>()); });
    connect(m_look, &QPushButton::clicked, this, [&search] { search.isRunning() ? search.cancel() : search.start(); });
    connect(m_go, &QPushButton::clicked, this, [&search] { search.goToBest(); });
    connect(m_optimize, &QPushButton::clicked, this,
            [&search] { search.isOptimizing() ? search.cancelOptimizing() : search.optimize(); });
    connect(m_globe, &ViewGlobe::hovered, this, [this, &search](const Vec3& toward) {
        if (m_services.store().hasVolume()) search.setGlimpse(search.cameraFor(toward));
    });
    connect(m_globe, &ViewGlobe::left, this, [&search] { search.setGlimpse({}); });
    connect(m_globe, &ViewGlobe::chosen, this, [this, &search](const Vec3& toward) {
        if (m_services.store().hasVolume()) search.goTo(search.cameraFor(toward));
    });
    connect(m_globe, &ViewGlobe::dragBegan, this, [this] { m_gesture = SessionStore::newGesture(); });
    connect(m_globe, &ViewGlobe::dragged, this, [this](const QPointF& way) {
        SessionStore& store = m_services.store();
        if (!store.hasVolume()) return;
        store.setCamera(rotated(store.scene().camera, store.scene().volume->geometry(), -way.x() * kDegreesPerRadius,
                                way.y() * kDegreesPerRadius),
                        m_gesture);
    });
    m_globe->setWords([this](const Vec3& toward) {
        const ViewSearchController& views = m_search;
        if (views.map().isEmpty()) return anglesText(anglesOf(toward));
        const QString figure = figureText(views.map().metric, views.map().interpolated(toward), true);
        return tr("From %1: %2").arg(anglesText(anglesOf(toward)), figure) +
               (views.isCurrent() ? QString() : tr("\nin an earlier state"));
    });
    connect(&search, &ViewSearchController::changed, this, &ViewsPanel::refresh);
    connect(&services, &Services::readOnlyChanged, this, &ViewsPanel::refresh);
    connect(&services.results(), &Results::changed, this, &ViewsPanel::refresh);
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (!std::equal(before.tf.features.begin(), before.tf.features.end(), after.tf.features.begin(),
                        after.tf.features.end(),
                        [](const Feature& f, const Feature& g) { return f.id == g.id && f.name == g.name; }))
            fillFigures();
        refresh();
    });
    connect(&terms(), &Terms::changed, this, [this] {
        refresh();
        m_globe->update();
    });
    fillFigures();
    refresh();
}

void ViewsPanel::fillFigures() {
    const QSignalBlocker quiet(m_figure);
    m_figure->clear();
    m_figure->addItem(tr("Distance from the targets"), QVariant::fromValue(FeatureId(0)));
    for (const Feature& f : m_services.scene().tf.features)
        m_figure->addItem(tr("Attention on %1").arg(QString::fromStdString(f.name)), QVariant::fromValue(f.id));
}

QString ViewsPanel::words() const {
    const ViewSearchController& search = m_search;
    const SessionStore& store = m_services.store();
    if (!store.hasVolume()) return {};
    if (store.session().measure->profile == Profile::Published)
        return tr("The published profile looks along the grid alone: it has no other views.");
    if (store.scene().tf.features.empty()) return tr("The transfer function has no features to judge views by.");
    if (search.isOptimizing()) return tr("Looking for the view and the opacities…");
    if (search.isRunning()) return tr("Trying views from all sides…");
    if (search.map().isEmpty()) return tr("No views have been tried yet.");
    if (!search.isCurrent()) return tr("The views were tried in an earlier state.");
    if (!search.best()) return tr("The search for the best view was stopped.");
    const ViewMetric& metric = search.map().metric;
    const BestView& best = *search.best();
    const Camera& camera = store.scene().camera;
    std::optional<double> here = measuredHere(metric);
    if (camera == best.best.camera) here = best.best.value;
    return tr("Best: %1, %2. From here: %3.")
        .arg(anglesText(anglesOf(-best.best.camera.forward())), figureText(metric, best.best.value, false),
             here ? figureText(metric, *here, false)
                  : figureText(metric, search.map().interpolated(-camera.forward()), true));
}

// The figure that the other panels have of this view.
std::optional<double> ViewsPanel::measuredHere(const ViewMetric& metric) const {
    const Results& results = m_services.results();
    if (!results.vwsIsCurrent()) return {};
    if (metric.figure == ViewMetric::Figure::Objective) return results.objective();
    return results.measures()->features.at(metric.feature).vws;
}

void ViewsPanel::refresh() {
    const ViewSearchController& search = m_search;
    const SessionStore& store = m_services.store();
    const bool ready = store.hasVolume() && !store.scene().tf.features.empty() && !m_services.isReadOnly() &&
                       store.session().measure->profile != Profile::Published;
    const bool current = search.isCurrent() && search.best();
    m_figure->setCurrentIndex(std::max(0, m_figure->findData(QVariant::fromValue(search.feature()))));
    m_figure->setEnabled(ready);
    std::optional<Vec3> best;
    if (search.best()) best = -search.best()->best.camera.forward();
    m_globe->setMap(search.map(), search.isCurrent() || search.isRunning(), best);
    if (store.hasVolume()) m_globe->setCamera(store.scene().camera, store.scene().volume->geometry().worldAxes);
    m_globe->setEnabled(store.hasVolume());
    m_progress->setVisible(search.isRunning() || search.isOptimizing());
    m_progress->setValue(static_cast<int>(100 * search.progress()));
    m_words->setText(words());
    m_look->setText(search.isRunning() ? tr("Stop") : tr("Look"));
    m_look->setToolTip(search.isRunning() ? tr("Stops the search; nothing else changes")
                                          : tr("Tries some hundred views from all sides on a coarser copy of "
                                               "the volume,\nthe best of them at full resolution"));
    m_look->setEnabled(search.isRunning() || (ready && !current));
    m_go->setEnabled(ready && current);
    m_optimize->setText(search.isOptimizing() ? tr("Stop") : tr("Optimize view and opacities"));
    m_optimize->setEnabled(ready);
}

} // namespace

PanelInfo viewsPanel() {
    return {.id = "views",
            .title = QObject::tr("Best view"),
            .group = PanelGroup::Shares,
            .area = Qt::LeftDockWidgetArea,
            .visible = false, // costs some hundred sweeps
            .size = 240,
            .keys = QKeySequence("Ctrl+B"),
            .tip = QObject::tr("How good each view is, as a sphere beside the picture"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                const QString sphere = QObject::tr("Sphere of views");
                services.actions().addGestures({{sphere, QObject::tr("Hover"), QObject::tr("look from there")},
                                                {sphere, QObject::tr("Click"), QObject::tr("go there")},
                                                {sphere, QObject::tr("Left drag"), QObject::tr("rotate")}});
                return new ViewsPanel(services, controllers.views, parent);
            }};
}

} // namespace pellucid::gui
