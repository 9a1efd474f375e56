#include "services/results.h"

#include <algorithm>

#include "optimize/objective.h"
#include "session/live_targets.h"
#include "tf/shown_tf.h"

namespace pellucid::gui {
namespace {

constexpr std::size_t kMostKnown = 64;
constexpr qint64 kLeastPause = 10; // milliseconds between two measurements while the hand moves

} // namespace

Results::Results(SessionStore& store, Lane& lane, Workspace& workspace, QObject* parent)
    : QObject(parent), m_store(store),
      m_measuring(
          [&workspace](const Request& request, const JobControl& job) {
              Figures figures{request.input, {}, {}, {}, {}, {}};
              if (request.measures) figures.measures = workspace.measure(request.input, job);
              if (request.influence) {
                  figures.influence = workspace.jacobian(request.input, job);
                  figures.occlusion = workspace.occlusion(request.input, job);
              }
              if (request.coverage) figures.coverage = workspace.coverage(request.input, job);
              figures.engine = QString::fromStdString(workspace.engine(request.input).name());
              return figures;
          },
          [this](const Request& request, Figures& figures) {
              m_lastTook = m_sinceStart.elapsed();
              m_failure.reset();
              m_engine = figures.engine;
              if (request.input == m_present || m_store.scene().volume == request.input.volume)
                  keep(std::move(figures));
              else
                  show(figures); // of the frame before
          },
          WhenBusy::FinishOld, &lane) {
    connect(&store, &SessionStore::changed, this, &Results::follow);
    connect(&m_measuring, &JobBase::failed, this, [this](const Error& error) {
        m_failure = error;
        Q_EMIT failed(error);
        Q_EMIT changed();
    });
    connect(&m_measuring, &JobBase::busyChanged, this, [this] {
        // What came meanwhile may not be what is there now.
        if (!m_measuring.isRunning() && !m_failure) request();
        Q_EMIT changed();
    });
}

void Results::follow(const Scene& before, const Scene& after) {
    MeasureInput input = measureInput(after);
    if (before.series != after.series || after.volume == nullptr) {
        // Nobody waits for figures of data that are gone.
        m_measuring.cancel();
        m_known.clear();
        m_measured = {};
        m_derived = {};
        m_engine.clear();
    } else if (before.volume != after.volume) {
        // Another frame: figures of the one before are shown as what they are, and a measurement under way is let
        // finish, else a series that plays would never have any. No more than two volumes are held.
        std::erase_if(m_known, [&](const Figures& f) {
            return f.input.volume != before.volume && f.input.volume != after.volume;
        });
        for (Figures* shown : {&m_measured, &m_derived})
            if (shown->input.volume != after.volume) shown->input.volume.reset();
    }
    if (input == m_present) {
        if (!sameFeatures(before.tf, after.tf)) Q_EMIT changed();
        return;
    }
    m_present = std::move(input);
    m_failure.reset();
    if (const auto at = known(m_present); at != m_known.end()) show(*at);
    request();
    Q_EMIT changed();
}

std::deque<Results::Figures>::const_iterator Results::known(const MeasureInput& input) const {
    return std::find_if(m_known.begin(), m_known.end(), [&](const Figures& f) { return f.input == input; });
}

void Results::keep(Figures figures) {
    show(figures);
    if (const auto at = known(figures.input); at != m_known.end()) {
        if (!figures.measures) figures.measures = at->measures;
        if (!figures.influence) {
            figures.influence = at->influence;
            figures.occlusion = at->occlusion;
        }
        if (figures.coverage && figures.measures) figures.measures->coverage = figures.coverage;
        m_known.erase(at);
    }
    m_known.push_front(std::move(figures));
    if (m_known.size() > kMostKnown) m_known.pop_back();
}

void Results::request() {
    if (m_paused || !m_store.hasVolume() || m_throttle.isActive()) return;
    if (measuresAreCurrent() && !lacksCoverage() && (!m_influenceWanted || influenceIsCurrent())) return;
    if (m_measuring.isRunning()) return; // its end asks again
    // The picture wants the processors too: half of the time is its own while the hand moves.
    const qint64 pause = m_sinceStart.isValid() ? std::max(kLeastPause, 2 * m_lastTook) - m_sinceStart.elapsed() : 0;
    m_throttle.start(static_cast<int>(std::clamp<qint64>(pause, 0, 1000)));
}

void Results::begin() {
    if (m_paused || !m_store.hasVolume()) return;
    const bool influence = m_influenceWanted && !influenceIsCurrent();
    const bool coverage = lacksCoverage();
    if (measuresAreCurrent() && !influence && !coverage) return;
    m_sinceStart.restart();
    m_measuring.start({m_present, !measuresAreCurrent(), influence, coverage},
                      QString::fromStdString(m_present.volume->title));
}

void Results::show(const Figures& figures) {
    if (figures.measures) {
        m_measured = figures;
        m_vwsOnly = false;
    }
    if (figures.coverage && m_measured.measures && m_measured.input == figures.input)
        m_measured.measures->coverage = figures.coverage;
    if (figures.influence) m_derived = figures;
}

bool Results::lacksCoverage() const { return measuresAreCurrent() && !m_measured.measures->coverage; }

bool Results::isShowable(const Figures& figures) const {
    return m_store.hasVolume() && sameFeatures(figures.input.tf, m_store.scene().tf);
}

bool Results::isPresent(const Figures& figures) const { return m_store.hasVolume() && figures.input == m_present; }

const Measures* Results::measures() const {
    return m_measured.measures && isShowable(m_measured) ? &*m_measured.measures : nullptr;
}

bool Results::vwsIsCurrent() const { return m_measured.measures && isPresent(m_measured); }

bool Results::measuresAreCurrent() const { return vwsIsCurrent() && !m_vwsOnly; }

const std::vector<std::vector<double>>* Results::influence() const {
    return m_derived.influence && isShowable(m_derived) ? &*m_derived.influence : nullptr;
}

const OcclusionMatrix* Results::occlusion() const { return influence() ? &m_derived.occlusion : nullptr; }

bool Results::influenceIsCurrent() const { return m_derived.influence && isPresent(m_derived); }

std::optional<double> Results::objective() const {
    const Measures* m = measures();
    const std::vector<double> targets = m_store.scene().targets();
    if (m == nullptr || targets.empty() || m->features.size() != targets.size()) return {};
    std::vector<double> vws;
    for (const FeatureMeasures& f : m->features) vws.push_back(f.vws);
    return objectiveOf(vws, targets);
}

Results::State Results::state() const {
    if (!m_store.hasVolume()) return State::Nothing;
    if (m_failure) return State::Failed;
    return measuresAreCurrent() ? State::Current : State::Measuring;
}

void Results::setInfluenceWanted(bool wanted) {
    if (m_influenceWanted == wanted) return;
    m_influenceWanted = wanted;
    request();
}

void Results::setPaused(bool paused) {
    if (m_paused == paused) return;
    m_paused = paused;
    if (paused) {
        m_throttle.stop();
        m_measuring.cancel();
    } else {
        request();
    }
    Q_EMIT changed();
}

MeasureInput Results::addVws(MeasureInput input, const TransferFunction& tf, const std::vector<double>& vws) {
    input.tf = shownTf(tf);
    if (!m_measured.measures || m_measured.measures->features.size() != vws.size()) return input;
    for (std::size_t i = 0; i < vws.size(); ++i) m_measured.measures->features[i].vws = vws[i];
    m_measured.input = input;
    m_vwsOnly = true; // shown, but not kept: the rest of it is of another state
    Q_EMIT changed();
    return input;
}

} // namespace pellucid::gui
