#include "controllers/target_actions.h"

#include <algorithm>

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>

#include "dialogs/closing_buttons.h"
#include "services/services.h"
#include "session/target_presets.h"
#include "store/edits.h"
#include "widgets/named.h"

namespace pellucid::gui {
namespace {

void setTargets(Services& services, const QString& text, const std::vector<double>& targets) {
    services.store().commit();
    editTargets(services.store(), targets, text);
}

void setTargetsAsNow(Services& services) {
    const Scene& scene = services.scene();
    std::vector<double> vws;
    for (const FeatureMeasures& f : services.results().measures()->features) vws.push_back(f.vws);
    setTargets(services, QObject::tr("Targets as now"), targetsByWeights(scene.wantedTf(), *scene.session.goals, vws));
}

void setTargetOfOne(Services& services) {
    const Scene& scene = services.scene();
    setTargets(
        services, QObject::tr("Target of one feature"),
        targetsForOne(scene.wantedTf(), *scene.session.goals, static_cast<std::size_t>(services.selectedFeature())));
}

void unlockTargets(Services& services) {
    services.store().commit();
    services.store().edit(QObject::tr("Unlock targets"), {}, [tf = services.scene().wantedTf()](Session& session) {
        for (std::size_t i = 0; i < tf.features.size(); ++i)
            session.goals.set(withTargetLocked(*session.goals, tf, i, false));
    });
}

void lockOpacity(Services& services, int feature) {
    OpacityLimits limits = opacityLimits(services.store(), feature);
    limits.locked = !limits.locked;
    editOpacityLimits(services.store(), feature, limits,
                      limits.locked ? QObject::tr("Lock opacity") : QObject::tr("Unlock opacity"));
}

/// Asks for the lowest and highest opacity of a feature.
void askLimits(Services& services, int feature) {
    const OpacityLimits limits = opacityLimits(services.store(), feature);
    QDialog dialog(services.window());
    dialog.setObjectName("limitsDialog");
    dialog.setWindowTitle(QObject::tr("Limits of the opacity"));
    auto* form = new QFormLayout(&dialog);
    const QString name = QString::fromStdString(services.selected()->name);
    form->addRow(new QLabel(QObject::tr("Optimize keeps the opacity of \"%1\" between").arg(name), &dialog));
    const auto box = [&](const char* id, double value, const QString& label) {
        auto* spin = new QDoubleSpinBox(&dialog);
        named(spin, id, QObject::tr("Opacity of the feature's peak, of a path one voxel long (d0), 0 to 1"));
        spin->setRange(0, 1);
        spin->setDecimals(4);
        spin->setSingleStep(0.01);
        spin->setValue(value);
        form->addRow(label, spin);
        return spin;
    };
    auto* lowest = box("lowestOpacity", limits.lowest, QObject::tr("&Lowest"));
    auto* highest = box("highestOpacity", limits.highest, QObject::tr("&Highest"));
    QObject::connect(lowest, &QDoubleSpinBox::valueChanged, highest,
                     [highest](double value) { highest->setValue(std::max(value, highest->value())); });
    QObject::connect(highest, &QDoubleSpinBox::valueChanged, lowest,
                     [lowest](double value) { lowest->setValue(std::min(value, lowest->value())); });
    form->addRow(closingButtons(dialog, QDialogButtonBox::Ok | QDialogButtonBox::Cancel));
    if (dialog.exec() != QDialog::Accepted) return;
    editOpacityLimits(services.store(), feature, {lowest->value(), highest->value(), limits.locked},
                      QObject::tr("Limits of opacity"));
}

} // namespace

void TargetActions::addActions() {
    Services& services = m_services;
    Actions& actions = services.actions();
    const auto editable = [&services] { return services.isEditable() && !services.scene().tf.features.empty(); };
    const auto selected = [&services, editable] {
        const int f = services.selectedFeature();
        return editable() && f >= 0 && !services.scene().wantedTf().features[static_cast<std::size_t>(f)].hidden;
    };
    ActionMenu menu(actions, QObject::tr("&Transfer function") + "/" + QObject::tr("Tar&gets"), editable);
    const auto addPreset = [&](const char* id, const QString& text, const QString& tip, const QString& step,
                               TargetPreset preset) {
        m_entries << menu.add(id, text, {}, tip, [&services, step, preset] {
            const Scene& scene = services.scene();
            setTargets(services, step, presetTargets(preset, scene.wantedTf(), *scene.session.goals));
        });
    };
    addPreset("targetsEqual", QObject::tr("&Equal"),
              QObject::tr("The same share for each feature; locked targets stay"), QObject::tr("Equal targets"),
              TargetPreset::Equal);
    addPreset("targetsDiagonal", QObject::tr("&Diagonal"),
              QObject::tr("In proportion to the value at each feature's peak; locked targets stay"),
              QObject::tr("Diagonal targets"), TargetPreset::Diagonal);
    m_entries << menu.add("targetsAsNow", QObject::tr("&As now"), {},
                          QObject::tr("The attention that each feature has now: the picture stays as it is"),
                          [&services] { setTargetsAsNow(services); }, {.enabled = [&services, editable] {
                              return editable() && services.results().vwsIsCurrent();
                          }});
    m_entries << menu.add("targetsOnlyThis", QObject::tr("&Only this one"), {},
                          QObject::tr("All for the selected feature, as far as locked targets leave it"),
                          [&services] { setTargetOfOne(services); }, {.enabled = selected});
    addPreset("targetsInsideOut", QObject::tr("&Inside out"),
              QObject::tr("The targets in reverse order; where they are all equal, Diagonal in reverse order"),
              QObject::tr("Targets inside out"), TargetPreset::InsideOut);
    auto* const gap = new QAction(&actions);
    gap->setSeparator(true);
    m_entries << gap;
    menu.separate();
    const auto goal = [&services] { // of the selected feature
        const Feature* const feature = services.selected();
        return feature == nullptr ? FeatureGoal() : goalOf(services.store().session(), feature->id);
    };
    m_entries << menu.add(
        "targetLock", QObject::tr("&Lock target"), {},
        QObject::tr("The selected feature's target stays where others are set (L in the bars)"),
        toSelected(services, [goal](Services& s, int f) { setTargetLocked(s.store(), f, !goal().targetLocked); }),
        {.enabled = selected, .checked = [goal] { return goal().targetLocked; }});
    m_entries << menu.add("targetsUnlock", QObject::tr("&Unlock all"), {},
                          QObject::tr("No target is locked; shares stay as they are"),
                          [&services] { unlockTargets(services); });
    ActionMenu limits(actions, QObject::tr("&Transfer function") + "/" + QObject::tr("Feat&ure"), selected);
    limits.separate();
    m_limits << limits.addCheck(
        "opacityLock", QObject::tr("Loc&k opacity"), {},
        QObject::tr("Optimize leaves the opacity of the selected feature as it is"), [goal] { return goal().locked; },
        toSelected(services, lockOpacity));
    m_limits << limits.add("opacityLimits", QObject::tr("L&imits of opacity…"), {},
                           QObject::tr("Between which opacities Optimize may move the selected feature"),
                           toSelected(services, askLimits));
    QObject::connect(&services.results(), &Results::changed, &actions, &Actions::refresh);
}

} // namespace pellucid::gui
