#include "controllers/probe_controller.h"

#include <algorithm>
#include <cmath>

#include "render/clip_handles.h"
#include "render/slice.h"
#include "services/services.h"
#include "store/edits.h"
#include "store/view_edits.h"
#include "tf/emphasis.h"
#include "tf/shown_tf.h"

namespace pellucid::gui {
namespace {

constexpr double kVisible = 1.0 / 255; ///< alpha from which on a pixel shows something
constexpr double kHides = 0.01;        ///< optical depth from which on a feature is in the way
constexpr double kClearly = 0.03;      ///< by so much a share should change, or by a quarter of what it can
constexpr int kMostSteps = 8;

} // namespace

ProbeController::ProbeController(Services& services) : m_services(services) {
    connect(&services.store(), &SessionStore::changed, this, &ProbeController::follow);
    connect(&services.selection(), &Selection::featureChanged, this, [this] {
        if (isActive()) Q_EMIT changed();
    });
    connect(this, &ProbeController::changed, &services.actions(), &Actions::refresh);
}

void ProbeController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&Transfer function"), [this] { return canEmphasize(); });
    menu.separate();
    menu.add("moreOfThisAction", tr("&More of this"), "Ctrl+]",
             tr("Raises the opacity of the feature under the probe and lowers that of what hides it there"),
             [this] { emphasize(true); });
    menu.add("lessOfThisAction", tr("&Less of this"), "Ctrl+[",
             tr("Lowers the opacity of the feature under the probe and raises that of what hides it there"),
             [this] { emphasize(false); });
    m_services.actions().addGestures({{tr("Volume"), tr("Click"), tr("probe: what the ray meets there")},
                                      {tr("Volume"), tr("Click beside the volume, Esc"), tr("end the probe")}});
}

void ProbeController::probeAt(const QPointF& point, const QSizeF& size, double pixelsPerPoint) {
    const Scene& scene = m_services.scene();
    if (!scene.volume || size.isEmpty()) return;
    const TransferFunction shown = shownTf(scene.tf);
    // The middle of the pixel, so that the shares are those of the picture.
    const auto middle = [&](double at) { return std::floor(at * pixelsPerPoint) + 0.5; };
    m_width = std::max(1, static_cast<int>(std::lround(size.width() * pixelsPerPoint)));
    m_height = std::max(1, static_cast<int>(std::lround(size.height() * pixelsPerPoint)));
    RayProbe ray = probe(*scene.volume, shown, {scene.camera, *scene.session.clipping}, middle(point.x()),
                         middle(point.y()), m_width, m_height, scene.onlyFeature());
    if (ray.alpha < kVisible) return clear();
    m_place = ray.position;
    m_tf = shown;
    const int main = ray.feature;
    m_ray = std::move(ray);
    if (main >= 0) m_services.selection().setFeature(scene.tf.features[static_cast<std::size_t>(main)].id);
    if (scene.session.slices->layout != SliceViews::Layout::Volume) moveCrosshairToWorld(m_services.store(), m_place);
    Q_EMIT changed();
}

void ProbeController::clear() {
    if (!isActive()) return;
    m_ray.reset();
    m_services.selection().setHoveredIntensity({});
    Q_EMIT changed();
}

std::optional<double> ProbeController::valueAtPlace() const {
    const Volume& volume = *m_services.scene().volume;
    return valueAt(volume, volume.geometry().voxelFromWorld(m_place));
}

int ProbeController::feature() const {
    const int selected = m_services.selectedFeature();
    const bool isMet = selected >= 0 && std::any_of(m_ray->runs.begin(), m_ray->runs.end(),
                                                    [&](const ProbeRun& run) { return run.feature == selected; });
    return isMet ? selected : m_ray->feature;
}

bool ProbeController::canEmphasize() const { return isActive() && !m_services.isReadOnly() && feature() >= 0; }

void ProbeController::emphasize(bool more) {
    if (!canEmphasize()) return;
    m_services.store().commit();
    const Scene& scene = m_services.scene();
    const auto f = static_cast<std::size_t>(feature());
    const QString name = QString::fromStdString(scene.tf.features[f].name);
    std::vector<double> inFront = depthInFront(*m_ray, f);
    for (double& depth : inFront)
        if (depth < kHides) depth = 0;
    std::vector<bool> held;
    for (const Feature& feature : scene.tf.features) held.push_back(goalOf(scene.session, feature.id).locked);
    const double share = m_ray->shares[f], wanted = std::min(kClearly, 0.25 * (more ? 1 - share : share));
    Emphasis emphasis;
    double change = 0;
    for (int steps = 1; steps <= kMostSteps && change < wanted; ++steps) {
        emphasis = withEmphasis(scene.tf, f, more ? steps : -steps, inFront, held);
        if (emphasis.changes.empty()) break;
        const auto ray = rayOf(shownTf(emphasis.tf));
        if (!ray) break;
        change = (more ? 1 : -1) * (ray->shares[f] - share);
    }
    if (emphasis.changes.empty())
        return Q_EMIT m_services.message(tr("%1 stays: it is locked, or its points are fixed").arg(name));
    if (!(change > 0))
        return Q_EMIT m_services.message(
            (more ? tr("There is no more of %1 to show here") : tr("There is no less of %1 to show here")).arg(name));
    editTf(m_services.store(), emphasis.tf, more ? tr("More of %1").arg(name) : tr("Less of %1").arg(name));
    Q_EMIT m_services.message(QString::fromStdString(emphasisText(emphasis)));
}

std::optional<RayProbe> ProbeController::rayOf(const TransferFunction& shown) const {
    const Scene& scene = m_services.scene();
    const auto pixel = pixelOf({scene.camera, m_width, m_height}, m_place);
    if (!pixel) return {};
    return probe(*scene.volume, shown, {scene.camera, *scene.session.clipping}, pixel->x, pixel->y, m_width, m_height,
                 scene.onlyFeature());
}

void ProbeController::follow(const Scene& before, const Scene& after) {
    if (!isActive()) return;
    if (before.data != after.data || !after.volume) return clear();
    if (before.volume == after.volume && before.tf == after.tf && before.camera == after.camera &&
        before.session.clipping.isSame(after.session.clipping) && before.onlyFeature() == after.onlyFeature())
        return;
    TransferFunction shown = shownTf(after.tf);
    auto ray = rayOf(shown);
    if (!ray || !ray->hit) return clear(); // beside the camera, or cut away
    m_tf = std::move(shown);
    m_ray = std::move(ray);
    Q_EMIT changed();
}

} // namespace pellucid::gui
