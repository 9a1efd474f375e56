#include "controllers/ruler_controller.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QFileInfo>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/atomic_file.h"
#include "dialogs/ask_file.h"
#include "render/probe.h"
#include "report/ruler_table.h"
#include "services/services.h"
#include "store/edits.h"
#include "tf/shown_tf.h"

namespace pellucid::gui {
namespace {

constexpr double kVisible = 1.0 / 255; ///< alpha from which on a pixel shows something

bool needsVoxels(const Ruler& ruler) { return ruler.kind == RulerKind::Sphere || ruler.kind == RulerKind::Box; }

/// Whether two say the same of the same data.
bool isSamePlace(const Ruler& a, const Ruler& b) {
    return a.kind == b.kind && a.points == b.points && a.radius == b.radius;
}

} // namespace

RulerController::RulerController(Services& services)
    : m_services(services),
      m_job([](const Task& task, const JobControl& job) { return readRulers(task.rulers, *task.data, job); },
            [this](const Task& task, const RulerReadings& readings) {
                for (const Ruler& ruler : task.rulers)
                    m_known[ruler.number] = {ruler, task.data, readings.at(ruler.number)};
                findMissing(); // of what has changed since
                Q_EMIT changed();
            },
            WhenBusy::FinishOld) {
    connect(&services.store(), &SessionStore::changed, this, &RulerController::follow);
    connect(&services, &Services::readOnlyChanged, this, [this] {
        if (m_services.isReadOnly()) giveUp();
    });
    connect(&m_job, &JobBase::busyChanged, this, &RulerController::busyChanged);
    connect(this, &RulerController::changed, &services.actions(), &Actions::refresh);
    services.showFailuresOf(m_job, tr("Cannot measure the values"));
}

void RulerController::addActions() {
    ActionMenu menu(m_services.actions(), tr("&Measure"), [this] { return m_services.isEditable(); });
    const auto add = [&](RulerKind kind, const QString& id, const QString& text, const QString& keys,
                         const QString& tip) {
        menu.addCheck(
            id, text, keys, tip, [this, kind] { return m_placing == kind; },
            [this, kind] { m_placing == kind ? giveUp() : begin(kind); });
    };
    add(RulerKind::Distance, "measureDistanceAction", tr("&Distance"), "M",
        tr("Two clicks, in the picture or in slices: the distance of what is seen there"));
    add(RulerKind::Angle, "measureAngleAction", tr("&Angle"), "Shift+M",
        tr("Three clicks, the second on the corner of the angle, in degrees"));
    add(RulerKind::Sphere, "measureSphereAction", tr("&Sphere"), {},
        tr("A click for the centre and one for the radius: mean, spread and range of the values in a sphere"));
    add(RulerKind::Box, "measureBoxAction", tr("&Box"), {},
        tr("A click for the centre and one for the size: mean, spread and range of the values in a box, whose faces "
           "can be dragged then"));
    menu.separate();
    menu.add("saveMeasuresAction", tr("Save measures as &table…"), {},
             tr("All measures, with units and coordinates, as a table (CSV)"), [this] { chooseFile(); },
             {.enabled = [this] { return !m_services.store().session().rulers->empty(); }});
    const QString place = tr("Measures");
    m_services.actions().addGestures({{place, tr("Drag an end, a centre, a rim or a face"), tr("change the measure")},
                                      {place, tr("Esc"), tr("give up one that is being set, or a drag")},
                                      {place, tr("Delete"), tr("remove the selected one")}});
}

RulerReadings RulerController::readings() const {
    RulerReadings readings;
    for (const Ruler& ruler : *m_services.scene().session.rulers) {
        if (!needsVoxels(ruler)) {
            readings[ruler.number] = readGeometry(ruler);
            continue;
        }
        const auto known = m_known.find(ruler.number);
        if (known != m_known.end() && known->second.data == m_services.scene().data)
            readings[ruler.number] = known->second.reading;
    }
    return readings;
}

QString RulerController::said(const Ruler& ruler, Words words) const {
    const RulerReadings all = readings();
    const auto known = all.find(ruler.number);
    if (known == all.end()) return QStringLiteral("…");
    const Volume& data = *m_services.scene().data;
    return QString::fromStdString(words(known->second, data.geometry(), data.range().hi - data.range().lo));
}

QString RulerController::textOf(const Ruler& ruler) const { return said(ruler, pellucid::textOf); }
QString RulerController::labelOf(const Ruler& ruler) const { return said(ruler, pellucid::labelOf); }

std::vector<ShownRuler> RulerController::shown() const {
    const Scene& scene = m_services.scene();
    if (!scene.volume) return {};
    std::vector<ShownRuler> all;
    if (scene.session.reference->on && scene.session.reference->measures) all = shownRulers(scene, readings());
    for (ShownRuler& one : all) one.isSelected = one.ruler.number == m_selected;
    if (!m_placing || (m_points.empty() && !m_pointer)) return all;
    // What is being set is seen whatever is hidden.
    const Volume& data = *scene.data;
    if (const auto ruler = m_pointer ? unfinished(*m_pointer) : std::nullopt) {
        all.push_back({*ruler, pellucid::labelOf(readGeometry(*ruler), data.geometry(), 1), true});
        return all;
    }
    if (m_points.empty()) return all;
    Ruler line{.kind = RulerKind::Distance, .points = {m_points.front(), m_points.back()}};
    if (m_pointer) line.points[1] = *m_pointer; // the first leg of an angle
    all.push_back({line, {}, true});
    return all;
}

std::vector<Ruler> RulerController::draggable() const {
    const Scene& scene = m_services.scene();
    if (!m_services.isEditable() || m_placing || !scene.session.reference->on || !scene.session.reference->measures)
        return {};
    return *scene.session.rulers;
}

// ---- one that is being set

void RulerController::begin(RulerKind kind) {
    if (!m_services.isEditable()) return;
    if (m_services.store().session().rulers->size() >= kMostRulers)
        return Q_EMIT m_services.message(tr("There are %1 measures already; remove some first").arg(kMostRulers));
    m_services.store().commit();
    m_placing = kind;
    m_points.clear();
    m_pointer.reset();
    Q_EMIT placingChanged();
    Q_EMIT changed();
}

void RulerController::giveUp() {
    if (!m_placing) return;
    m_placing.reset();
    m_points.clear();
    m_pointer.reset();
    Q_EMIT placingChanged();
    Q_EMIT changed();
}

QString RulerController::hint() const {
    if (!m_placing) return {};
    static const std::array<std::array<QString, 3>, 4> kHints{
        {{tr("Click on one end"), tr("Click on the other end"), {}},
         {tr("Click on the end of one leg"), tr("Click on the corner of the angle"),
          tr("Click on the end of the other leg")},
         {tr("Click on the centre of the sphere"), tr("Click where its surface is to be"), {}},
         {tr("Click on the centre of the box"), tr("Click where one of its faces is to be"), {}}}};
    return tr("%1 · Esc cancels")
        .arg(kHints.at(static_cast<std::size_t>(*m_placing)).at(std::min<std::size_t>(2, m_points.size())));
}

std::optional<Ruler> RulerController::unfinished(const Vec3& next) const {
    Ruler ruler{.kind = *m_placing, .points = m_points};
    ruler.points.push_back(next);
    if (ruler.points.size() < std::max<std::size_t>(2, pointsOf(ruler.kind))) return {};
    const Vec3 center = ruler.points[0];
    if (ruler.kind == RulerKind::Distance && next == center) return {}; // a double click
    if (ruler.kind == RulerKind::Sphere) {
        ruler.points = {center};
        ruler.radius = glm::length(next - center);
    }
    if (ruler.kind == RulerKind::Box) { // a cube, on whose surface the second point lies
        const Vec3 off = glm::abs(next - center);
        const Vec3 half(std::max({off.x, off.y, off.z}));
        if (half.x == 0) return {};
        ruler = boxRuler(center - half, center + half);
    }
    return rulerProblem(ruler).empty() ? std::optional(ruler) : std::nullopt;
}

std::optional<Vec3> RulerController::center() const {
    const bool hasOne = m_placing == RulerKind::Sphere || m_placing == RulerKind::Box;
    return hasOne && !m_points.empty() ? std::optional(m_points.front()) : std::nullopt;
}

void RulerController::addPoint(const Vec3& world) {
    if (!m_placing || !m_services.isEditable()) return;
    const std::optional<Ruler> whole = unfinished(world);
    if (!whole) {
        if (m_points.empty() || m_points.back() != world) m_points.push_back(world);
        if (m_points.size() > 2) m_points.pop_back(); // a leg of an angle without length
        return Q_EMIT changed();
    }
    giveUp();
    int number = 0;
    editPart(m_services.store(), &Session::rulers, tr("Measure"), {},
             [&](std::vector<Ruler>& rulers) { number = addRuler(rulers, *whole); });
    select(number);
    if (!m_services.store().session().reference->measures || !m_services.store().session().reference->on)
        Q_EMIT m_services.message(tr("Measures are hidden: View, Annotations, Measures shows them"));
}

void RulerController::pointAt(const std::optional<Vec3>& world) {
    if (!m_placing || m_pointer == world) return;
    m_pointer = world;
    Q_EMIT changed();
}

std::optional<Vec3> RulerController::seenAt(const Camera& camera, const QPointF& point, const QSizeF& size) const {
    const Scene& scene = m_services.scene();
    if (!scene.volume || size.isEmpty()) return {};
    const RayProbe ray = probe(*scene.volume, shownTf(scene.tf), {camera, *scene.session.clipping}, point.x(),
                               point.y(), std::max(1, static_cast<int>(size.width())),
                               std::max(1, static_cast<int>(size.height())), scene.onlyFeature());
    return ray.alpha < kVisible ? std::nullopt : std::optional(ray.position);
}

void RulerController::sayNothingSeen() {
    Q_EMIT m_services.message(tr("There is nothing there: click on something you can see, or in a slice"));
}

// ---- those that are there

const Ruler* RulerController::find(int number) const {
    const std::vector<Ruler>& all = *m_services.scene().session.rulers;
    const auto found = std::find_if(all.begin(), all.end(), [=](const Ruler& r) { return r.number == number; });
    return found == all.end() ? nullptr : &*found;
}

void RulerController::select(int number) {
    if (m_selected == number) return;
    m_selected = number;
    Q_EMIT changed();
}

void RulerController::edit(const QString& text, int number, const std::function<void(Ruler&)>& change) {
    if (!m_services.isEditable()) return;
    editPart(m_services.store(), &Session::rulers, text, {}, [&](std::vector<Ruler>& rulers) {
        for (Ruler& ruler : rulers)
            if (ruler.number == number) change(ruler);
    });
}

void RulerController::preview(const Ruler& moved) {
    m_services.store().preview(tr("Change %1").arg(QString::fromStdString(moved.name)),
                               changing(&Session::rulers, [moved](std::vector<Ruler>& rulers) {
                                   for (Ruler& ruler : rulers)
                                       if (ruler.number == moved.number) ruler = moved;
                               }));
}

void RulerController::remove(int number) {
    const Ruler* const ruler = find(number);
    if (ruler == nullptr || !m_services.isEditable()) return;
    editPart(
        m_services.store(), &Session::rulers, tr("Remove %1").arg(QString::fromStdString(ruler->name)), {},
        [&](std::vector<Ruler>& rulers) { std::erase_if(rulers, [=](const Ruler& r) { return r.number == number; }); });
}

void RulerController::rename(int number, const QString& name) {
    if (name.trimmed().isEmpty()) return;
    edit(tr("Rename measure"), number, [&](Ruler& ruler) { ruler.name = name.trimmed().toStdString(); });
}

void RulerController::setShown(int number, bool shown) {
    edit(shown ? tr("Show measure") : tr("Hide measure"), number, [=](Ruler& ruler) { ruler.shown = shown; });
}

void RulerController::follow(const Scene& before, const Scene& after) {
    if (before.series != after.series) {
        m_job.cancel();
        m_known.clear();
        m_selected = 0;
        giveUp();
    }
    if (before.data == after.data && before.session.rulers.isSame(after.session.rulers) &&
        before.session.reference.isSame(after.session.reference) &&
        before.session.coordinates.isSame(after.session.coordinates))
        return;
    if (find(m_selected) == nullptr) m_selected = 0;
    findMissing();
    Q_EMIT changed();
}

bool RulerController::isKnown(const Ruler& ruler) const {
    const auto known = m_known.find(ruler.number);
    return !needsVoxels(ruler) || (known != m_known.end() && known->second.data == m_services.scene().data &&
                                   isSamePlace(known->second.ruler, ruler));
}

void RulerController::findMissing() {
    if (!m_services.store().hasVolume()) return;
    Task task{{}, m_services.scene().data};
    for (const Ruler& ruler : *m_services.scene().session.rulers)
        if (!isKnown(ruler)) task.rulers.push_back(ruler);
    if (!task.rulers.empty()) m_job.start(std::move(task), tr("the measures"));
}

void RulerController::chooseFile() {
    const QString title = QFileInfo(QString::fromStdString(m_services.scene().data->title)).baseName();
    const QString path = askSavePath(m_services.window(), tr("Save measures"), "measuresFolder",
                                     title + "_measures.csv", tr("Tables (*.csv)"), ".csv", ".csv");
    if (!path.isEmpty()) exportTo(path);
}

bool RulerController::exportTo(const QString& path) {
    return m_services.attempt(tr("Cannot save the measures"), [&] {
        const Scene& scene = m_services.scene();
        // What is still being found is found now: a table has no gaps.
        writeTextAtomically(path.toStdString(),
                            csvOf(*scene.session.rulers, readRulers(*scene.session.rulers, *scene.data),
                                  scene.data->geometry(), scene.session.coordinates->axes));
        m_services.saySaved(path);
    });
}

} // namespace pellucid::gui
