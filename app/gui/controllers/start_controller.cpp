#include "controllers/start_controller.h"

#include "controllers/open_controller.h"
#include "services/services.h"
#include "store/edits.h"
#include "store/view_edits.h"
#include "widgets/number_text.h"

namespace pellucid::gui {
namespace {

/// "fat, soft tissue, bone"
QString namesOf(const Proposal& proposal) {
    QStringList names;
    for (const ProposedFeature& f : proposal.features) names << QString::fromStdString(f.name);
    return names.join(QStringLiteral(", "));
}

/// Of voxels: "0.001 %", no more digits than it needs.
QString percentText(double share) {
    if (!(share >= 1e-5)) return QObject::tr("under 0.001 %");
    return QString::number(100 * share, 'g', 2) + QStringLiteral(" %");
}

} // namespace

QString recognisedText(const Proposal& proposal) {
    if (proposal.kind == DataKind::Ct)
        return (proposal.background ? QObject::tr("CT in Hounsfield units: air left out; %1.")
                                    : QObject::tr("CT in Hounsfield units: %1."))
            .arg(namesOf(proposal));
    if (proposal.kind == DataKind::Signed)
        return QObject::tr("Values of both signs: colours change at 0, and values near 0 are left out.");
    if (proposal.kind == DataKind::Labels) return QObject::tr("Labels: a feature for each.");
    return {}; // what is constant, the loader has said
}

QString beyondText(const Proposal& proposal, const ValueRange& data) {
    const ValueRange& window = proposal.window;
    const bool below = data.lo < window.lo;
    const bool above = data.hi > window.hi;
    if (!(data.lo < data.hi) || (!below && !above)) return {};
    const auto plain = [](double v) { return QString::number(v, 'g', 4).replace('-', QChar(0x2212)); };
    const QString ends = below && above ? QObject::tr("%1 and %2").arg(plain(data.lo), plain(data.hi))
                                        : plain(below ? data.lo : data.hi);
    return QObject::tr("Range clipped to %1…%2 (%3 of voxels outside, up to %4).")
        .arg(plain(window.lo), plain(window.hi), percentText(proposal.outside), ends);
}

StartController::StartController(Services& services, OpenController& opening)
    : m_services(services), m_opening(opening),
      m_tuning([](const Scene& scene, const JobControl& job) { return tunedStart(scene, job); },
               [this](const Scene& scene, FirstSight& start) { showTuned(scene, start); }),
      m_again([](const Request& request,
                 const JobControl& job) { return automaticStart(request.scene, request.view, job); },
              [this](const Request& request, AutomaticStart& start) {
                  if (request.scene.data != m_services.scene().data || m_services.isReadOnly()) return;
                  const auto change = [window = start.window, sight = start.sight](Session& session) {
                      editVariable(session, [&](Variable& v) { v.window = window; });
                      setStart(session, sight);
                  };
                  m_opening.editData(tr("Automatic start"), change,
                                     [this, proposal = start.proposal] { say(proposal); });
              }) {
    connect(&opening, &OpenController::opened, this, &StartController::follow);
    connect(&opening, &OpenController::automaticStartWanted, this, &StartController::startAgain);
    connect(&m_tuning, &JobBase::busyChanged, this, &StartController::busyChanged);
    connect(&m_again, &JobBase::busyChanged, this, &StartController::busyChanged);
    services.showFailuresOf(m_again, tr("Automatic start failed"));
    // Who has other features knows better.
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        const auto names = [](const Scene& scene) {
            std::vector<std::string> all;
            for (const Feature& feature : scene.tf.features) all.push_back(feature.name);
            return all;
        };
        if (m_said.isEmpty() || before.data != after.data || names(before) == names(after)) return;
        m_services.notices().remove(m_said);
        m_said.clear();
    });
}

void StartController::addActions() {
    m_services.actions().add(
        tr("&Transfer function"), "automaticStartAction", tr("&Automatic start"), {},
        tr("Takes the range of values and the features from the data, and finds opacities for this view"),
        [this] { startAgain(); }, [this] { return m_services.isEditable(); });
}

void StartController::follow() {
    const Scene& scene = m_services.scene();
    m_tuning.cancel();
    m_again.cancel();
    if (!scene.proposal) return;
    say(*scene.proposal);
    m_tuning.start(scene, QString::fromStdString(scene.volume->title));
}

void StartController::startAgain() {
    if (!m_services.isEditable()) return;
    m_services.store().commit();
    const Scene& scene = m_services.scene();
    m_again.start({scene, {scene.camera, *scene.session.clipping}}, QString::fromStdString(scene.volume->title));
}

void StartController::cancel() {
    m_tuning.cancel();
    m_again.cancel();
}

void StartController::say(const Proposal& proposal) {
    m_said = recognisedText(proposal);
    if (!m_said.isEmpty()) m_services.notices().add({m_said});
    const QString beyond = beyondText(proposal, m_services.scene().data->dataRange());
    if (beyond.isEmpty()) return;
    const auto showAll = [this] {
        m_opening.editData(tr("Full range"),
                           [](Session& session) { editVariable(session, [](Variable& v) { v.window.reset(); }); });
    };
    m_services.notices().add({beyond, {{tr("Show full range"), showAll}}});
}

void StartController::showTuned(const Scene& scene, const FirstSight& start) {
    SessionStore& store = m_services.store();
    // Whoever has a hand in it keeps what he has.
    if (store.scene().data != scene.data || store.isPreviewing() || m_services.isReadOnly() ||
        store.session().tf() != scene.session.tf() || store.scene().volume != scene.volume)
        return;
    const bool clean = store.isClean();
    store.edit(tr("Automatic opacities"), {}, [&](Session& session) {
        const Part<Clipping> clipping = session.clipping;
        setStart(session, start);
        if (!clipping.isSame(scene.session.clipping)) session.clipping = clipping; // somebody has been faster
    });
    if (clean) store.setClean(); // it is not the user's work
}

} // namespace pellucid::gui
