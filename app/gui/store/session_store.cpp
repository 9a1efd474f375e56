#include "store/session_store.h"

#include <algorithm>
#include <set>

#include "base/check.h"
#include "session/scene_data.h"

namespace pellucid::gui {
namespace {

constexpr std::size_t kMostSteps = 500;
constexpr std::size_t kMostCameras = 200;
constexpr std::size_t kMostData = 3; // volumes that the history keeps in memory, the present one among them

// The session without where and when one looks, which has a history of its own or none, and without what is made for
// frames by itself.
Session withoutGaze(Session session) {
    session.camera.reset();
    session.comparison = {};
    if (session.slices->crosshair) session.slices.edit([](SliceViews& s) { s.crosshair.reset(); });
    session.frame = 0;
    session.goals.set(goalsAt(session, 0));
    if (session.hsb->found != HsbMapping::Found{}) session.hsb.edit([](HsbMapping& mapping) { mapping.found = {}; });
    if (!session.isEmpty() && !session.variable().track.adapted.empty())
        session.variables.edit([](std::vector<Variable>& all) { all.front().track.adapted.clear(); });
    return session;
}

bool isSeries(const Scene& scene) { return scene.series != nullptr && scene.series->varies(); }

// What a step keeps of a scene. What can be made anew is not kept for a state that may never come back; of a series,
// nothing of its frames.
Scene kept(Scene scene, const Scene& other) {
    scene.codes.reset();
    if (!isSeries(scene) || scene.series != other.series) return scene;
    scene.data.reset();
    scene.volume.reset();
    scene.histogram.reset();
    scene.colors.reset();
    return scene;
}

} // namespace

SessionStore::SessionStore(QObject* parent) : QObject(parent) {}

void SessionStore::open(Scene scene) {
    m_committed.reset();
    m_steps.clear();
    m_index = 0;
    m_cameras = {scene.camera};
    m_cameraIndex = 0;
    m_lastGesture = 0;
    scene.session.camera = scene.camera;
    m_clean = scene.session;
    show(std::move(scene));
    Q_EMIT historyChanged();
}

void SessionStore::show(Scene next) {
    const Scene before = std::exchange(m_scene, std::move(next));
    const Scene after = m_scene; // whoever hears of it may change it again
    Q_EMIT changed(before, after);
}

Scene SessionStore::changedBy(const Change& change, const Scene& from, const Scene& basis, QString& text) const {
    Session session = from.session;
    change(session);
    PELLUCID_CHECK(!needsData(session, basis));
    Scene next = resolve(std::move(session), basis);
    if (!m_consequence || next.session == from.session) return next;
    session = next.session;
    const QString consequence = m_consequence(from, next, session);
    if (consequence.isEmpty()) return next;
    PELLUCID_CHECK(!needsData(session, basis));
    text = tr("%1, %2").arg(text, consequence);
    return resolve(std::move(session), next);
}

Scene SessionStore::withPresentGaze(Scene scene) const {
    scene.session.camera = m_scene.session.camera;
    scene.camera = m_scene.camera;
    scene.session.comparison = m_scene.session.comparison;
    const auto& crosshair = m_scene.session.slices->crosshair;
    if (scene.session.slices->crosshair != crosshair)
        scene.session.slices.edit([&](SliceViews& s) { s.crosshair = crosshair; });
    return scene;
}

// The session at a frame, with the data of `basis`.
Scene SessionStore::atFrame(Session session, int frame, Scene basis) {
    session.frame = frame;
    session.goals.set(goalsAt(session, frame));
    basis.session.goals = session.goals; // so that following the target keys takes none of them for an edit
    basis.session.targetKeys = session.targetKeys;
    return resolve(std::move(session), basis);
}

// A scene of another frame at the present one.
Scene SessionStore::atPresentFrame(Scene scene) const {
    scene = withPresentGaze(std::move(scene));
    if (!isSeries(scene) || scene.series != m_scene.series) return scene; // with other data come its frames
    // Data that are there are seen through another window at once.
    Scene basis = m_scene;
    if (scene.ground) { // kept with the step
        basis.session.ground = scene.session.ground;
        basis.ground = scene.ground;
    }
    if (scene.overlay) {
        basis.session.overlay = scene.session.overlay;
        basis.overlay = scene.overlay;
    }
    Scene next = atFrame(scene.session, m_scene.session.frame, std::move(basis));
    prepareToShow(next);
    return next;
}

Scene SessionStore::movedTo(const Scene& shown, const Scene& from) {
    Session session = from.session;
    session.hsb = shown.session.hsb; // with scales that were found in this frame
    Scene basis = shown;
    basis.session.ground = from.session.ground; // one ground lies under all frames
    basis.ground = from.ground;
    basis.session.overlay = from.session.overlay; // and one overlay over them
    basis.overlay = from.overlay;
    return atFrame(std::move(session), shown.session.frame, std::move(basis));
}

bool SessionStore::isShownBy(const Scene& shown) const {
    if (!isSeries(m_scene) || shown.series != m_scene.series || shown.volume == nullptr) return false;
    const auto fits = [&](const Scene& scene) {
        Session session = scene.session;
        session.frame = shown.session.frame;
        return !needsData(session, shown) && session.hsb->isKeptBy(*shown.session.hsb) &&
               sameData(*session.variables, *shown.session.variables);
    };
    return fits(m_scene) && (!m_committed || fits(*m_committed));
}

void SessionStore::setFrame(const Scene& shown) {
    PELLUCID_CHECK(isShownBy(shown));
    if (shown.session.frame == m_scene.session.frame) return;
    if (m_committed) m_committed = movedTo(shown, *m_committed);
    show(movedTo(shown, m_scene));
}

void SessionStore::push(const QString& text, const QString& mergeKey, Scene before,
                        std::optional<Step::Compared> compared) {
    Scene after = kept(m_scene, before);
    before = kept(std::move(before), m_scene);
    if (withoutGaze(before.session) == withoutGaze(m_scene.session)) return;
    m_steps.resize(m_index);
    const bool merges = !mergeKey.isEmpty() && m_index > 0 && m_steps.back().mergeKey == mergeKey;
    if (merges) {
        m_steps.back().after = std::move(after);
        if (withoutGaze(m_steps.back().before.session) == withoutGaze(m_scene.session)) {
            m_steps.pop_back(); // there and back again
            --m_index;
        }
    } else {
        m_steps.push_back({text, mergeKey, std::move(before), std::move(after), std::move(compared)});
        ++m_index;
        if (m_steps.size() > kMostSteps) {
            m_steps.erase(m_steps.begin());
            --m_index;
        }
        forgetOldData();
    }
}

// A step keeps the data that it needs to be undone at once. Memory ends before the history does: of the oldest steps
// that need yet other volumes there is no way back.
void SessionStore::forgetOldData() {
    std::set<const Volume*> volumes;
    std::size_t first = m_steps.size();
    while (first > 0) {
        for (const Scene* scene : {&m_steps[first - 1].before, &m_steps[first - 1].after})
            for (const auto& volume : {scene->data, scene->overlay ? scene->overlay->volume : nullptr})
                if (volume) volumes.insert(volume.get());
        if (volumes.size() > kMostData) break;
        --first;
    }
    m_steps.erase(m_steps.begin(), m_steps.begin() + static_cast<std::ptrdiff_t>(first));
    m_index -= std::min(m_index, first);
}

void SessionStore::edit(const QString& text, const QString& mergeKey, const Change& change, const Scene* basis) {
    if (!hasVolume()) return;
    commit();
    QString name = text;
    Scene next = changedBy(change, m_scene, basis == nullptr ? m_scene : *basis, name);
    if (next.session == m_scene.session) return;
    Scene before = m_scene;
    std::optional<Step::Compared> compared;
    if (const auto& from = before.session.comparison->b, &to = next.session.comparison->b; from != to)
        compared = {from, to};
    show(std::move(next));
    push(name, mergeKey, std::move(before), std::move(compared));
    Q_EMIT historyChanged();
}

void SessionStore::preview(const QString& text, const Change& change) {
    if (!hasVolume()) return;
    const bool first = !m_committed;
    if (first) m_committed = m_scene;
    m_previewText = text;
    const Scene from = withPresentGaze(*m_committed); // the view may turn meanwhile
    if (first) m_amendment = {};
    const Change both = [&](Session& session) {
        change(session);
        if (m_amendment) m_amendment(session);
    };
    Scene next = changedBy(both, from, from, m_previewText);
    if (!(next.session == m_scene.session)) show(std::move(next));
    if (first) Q_EMIT historyChanged();
}

void SessionStore::record(const Change& change) {
    if (m_committed) change(m_committed->session);
}

void SessionStore::commit(const QString& mergeKey) {
    endPreview([&](Scene before) { push(m_previewText, mergeKey, std::move(before)); });
}

void SessionStore::cancel() {
    endPreview([this](Scene before) { show(std::move(before)); });
}

void SessionStore::endPreview(const std::function<void(Scene before)>& end) {
    if (!m_committed) return;
    Scene before = withPresentGaze(std::move(*m_committed));
    m_committed.reset();
    end(std::move(before));
    Q_EMIT historyChanged();
}

void SessionStore::amend(const Change& change) {
    if (!hasVolume()) return;
    Session session = m_scene.session;
    change(session);
    PELLUCID_CHECK(!needsData(session, m_scene));
    if (session == m_scene.session) return;
    if (isPreviewing()) m_amendment = change;
    const bool clean = isClean();
    const bool isLatest = !isPreviewing() && m_index > 0 && m_index == m_steps.size();
    show(resolve(std::move(session), m_scene));
    if (isPreviewing()) return;
    if (isLatest) m_steps.back().after = kept(m_scene, m_steps.back().before);
    if (clean) setClean();
}

QString SessionStore::undoText() const {
    if (isPreviewing()) return m_previewText;
    return m_index > 0 ? m_steps[m_index - 1].text : QString();
}

QString SessionStore::redoText() const { return canRedo() ? m_steps[m_index].text : QString(); }

void SessionStore::undo() {
    if (isPreviewing()) return cancel(); // a drag under way is what is undone
    if (m_index == 0) return;
    const Step& step = m_steps[m_index - 1];
    Scene before = atPresentFrame(step.before); // may throw: then nothing has happened
    if (step.compared) before.session.comparison.edit([&](ComparisonView& view) { view.b = step.compared->before; });
    --m_index;
    show(std::move(before));
    Q_EMIT historyChanged();
}

void SessionStore::redo() {
    if (isPreviewing()) cancel();
    if (m_index >= m_steps.size()) return;
    const Step& step = m_steps[m_index];
    Scene after = atPresentFrame(step.after);
    if (step.compared) after.session.comparison.edit([&](ComparisonView& view) { view.b = step.compared->after; });
    ++m_index;
    show(std::move(after));
    Q_EMIT historyChanged();
}

int SessionStore::newGesture() {
    static int s_last = 0;
    return ++s_last;
}

void SessionStore::setCamera(const Camera& camera, int gesture) {
    if (!hasVolume() || camera == m_scene.camera) return;
    const bool sameStep = gesture != 0 && gesture == m_lastGesture && m_cameraIndex + 1 == m_cameras.size();
    m_lastGesture = gesture;
    if (!sameStep) {
        m_cameras.resize(m_cameraIndex + 1);
        m_cameras.push_back(camera);
        if (m_cameras.size() > kMostCameras) m_cameras.erase(m_cameras.begin());
        m_cameraIndex = m_cameras.size() - 1;
    }
    m_cameras[m_cameraIndex] = camera;
    showCamera(camera);
    if (!sameStep) Q_EMIT historyChanged();
}

void SessionStore::undoCamera() {
    if (canUndoCamera()) goToCamera(m_cameraIndex - 1);
}

void SessionStore::redoCamera() {
    if (canRedoCamera()) goToCamera(m_cameraIndex + 1);
}

void SessionStore::goToCamera(std::size_t index) {
    m_cameraIndex = index;
    m_lastGesture = 0;
    showCamera(m_cameras[index]);
    Q_EMIT historyChanged();
}

void SessionStore::showCamera(const Camera& camera) {
    Scene next = m_scene;
    next.session.camera = next.camera = camera;
    show(std::move(next));
}

void SessionStore::setCrosshair(const Vec3& voxel) {
    if (!hasVolume() || m_scene.session.slices->crosshair == voxel) return;
    Scene next = m_scene;
    next.session.slices.edit([&](SliceViews& s) { s.crosshair = voxel; });
    show(std::move(next));
}

void SessionStore::setComparison(const std::function<void(ComparisonView&)>& change) {
    if (!hasVolume()) return;
    Scene next = m_scene;
    next.session.comparison.edit(change);
    if (!next.session.comparison.isSame(m_scene.session.comparison)) show(std::move(next));
}

bool SessionStore::isClean() const { return m_clean && withoutGaze(*m_clean) == withoutGaze(committed().session); }

void SessionStore::setClean() {
    m_clean = committed().session;
    Q_EMIT historyChanged();
}

void SessionStore::setUnsaved() {
    m_clean.reset();
    Q_EMIT historyChanged();
}

void SessionStore::setTfSaved() {
    if (!m_clean) return;
    Session other = committed().session;
    // Were the transfer function as before, would anything be unsaved?
    other.variables.edit([&](std::vector<Variable>& all) {
        if (!all.empty() && !m_clean->isEmpty()) {
            all.front().track = m_clean->variable().track;
            all.front().window = m_clean->variable().window; // the file says it
        }
    });
    for (const auto& [id, goal] : *m_clean->goals) {
        const auto now = other.goals->find(id);
        if (now == other.goals->end() || now->second.target != goal.target || now->second.locked != goal.locked ||
            now->second.lowest != goal.lowest || now->second.highest != goal.highest ||
            now->second.targetLocked != goal.targetLocked)
            return;
    }
    other.goals = m_clean->goals; // those of new features came with them
    if (withoutGaze(other) == withoutGaze(*m_clean)) setClean();
}

} // namespace pellucid::gui
