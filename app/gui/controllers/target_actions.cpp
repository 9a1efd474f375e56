#include "controllers/target_actions.h"

#include <algorithm>

#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>

#include "services/services.h"
#include "session/target_presets.h"
#include "store/edits.h"

namespace pellucid::gui {
namespace {

QString targetMenu() { return QObject::tr("&Transfer function") + "/" + QObject::tr("Tar&gets"); }

void setTargets(Services& services, const QString& text, const std::vector<double>& targets) {
    services.store().commit();
    editTargets(services.store(), targets, text);
}

void setPreset(Services& services, const QString& text, TargetPreset preset) {
    setTargets(services, text, presetTargets(preset, services.scene().wantedTf(), *services.scene().session.goals));
}

/// Lowest and highest opacity of a feature.
void askLimits(Services& services, int feature) {
    const OpacityLimits limits = opacityLimits(services.store(), feature);
    QDialog dialog(services.window());
    dialog.setObjectName("limitsDialog");
    dialog.setWindowTitle(QObject::tr("Limits of the opacity"));
    auto* form = new QFormLayout(&dialog);
    const QString name =
        QString::fromStdString(services.scene().tf.features.at(static_cast<std::size_t>(feature)).name);
    form->addRow(new QLabel(QObject::tr("Optimize keeps the opacity of \"%1\" between").arg(name), &dialog));
    const auto box = [&](const char* id, double value, const QString& label) {
        auto* spin = new QDoubleSpinBox(&dialog);
        spin->setObjectName(id);
        spin->setRange(0, 1);
        spin->setDecimals(4);
        spin->setSingleStep(0.01);
        spin->setValue(value);
        spin->setToolTip(QObject::tr("Opacity of the feature's peak, of a path one voxel long (d0), 0 to 1"));
        form->addRow(label, spin);
        return spin;
    };
    auto* lowest = box("lowestOpacity", limits.lowest, QObject::tr("&Lowest"));
    auto* highest = box("highestOpacity", limits.highest, QObject::tr("&Highest"));
    QObject::connect(lowest, &QDoubleSpinBox::valueChanged, highest,
                     [highest](double value) { highest->setValue(std::max(value, highest->value())); });
    QObject::connect(highest, &QDoubleSpinBox::valueChanged, lowest,
                     [lowest](double value) { lowest->setValue(std::min(value, lowest->value())); });
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
    form->addRow(buttons);
    QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
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
    const auto add = [&](const char* id, const QString& text, const QString& tip, auto trigger, auto enabled) {
        m_entries << actions.add(targetMenu(), id, text, {}, tip, trigger, enabled);
    };
    add(
        "targetsEqual", QObject::tr("&Equal"), QObject::tr("The same share for each feature; locked targets stay"),
        [&services] { setPreset(services, QObject::tr("Equal targets"), TargetPreset::Equal); }, editable);
    add(
        "targetsDiagonal", QObject::tr("&Diagonal"),
        QObject::tr("In proportion to the value at each feature's peak; locked targets stay"),
        [&services] { setPreset(services, QObject::tr("Diagonal targets"), TargetPreset::Diagonal); }, editable);
    add(
        "targetsAsNow", QObject::tr("&As now"),
        QObject::tr("The VWS that each feature has now: what the picture shows is what is wanted"),
        [&services] {
            std::vector<double> vws;
            for (const FeatureMeasures& f : services.results().measures()->features) vws.push_back(f.vws);
            setTargets(services, QObject::tr("Targets as now"),
                       targetsByWeights(services.scene().wantedTf(), *services.scene().session.goals, vws));
        },
        [&services, editable] { return editable() && services.results().vwsIsCurrent(); });
    add(
        "targetsOnlyThis", QObject::tr("&Only this one"),
        QObject::tr("All for the selected feature, as far as locked targets leave it"),
        [&services] {
            setTargets(services, QObject::tr("Target of one feature"),
                       targetsForOne(services.scene().wantedTf(), *services.scene().session.goals,
                                     static_cast<std::size_t>(services.selectedFeature())));
        },
        selected);
    add(
        "targetsInsideOut", QObject::tr("&Inside out"),
        QObject::tr("The targets in reverse order; where they are all equal, Diagonal in reverse order"),
        [&services] { setPreset(services, QObject::tr("Targets inside out"), TargetPreset::InsideOut); }, editable);
    const auto goalOf = [&services](int f) {
        const FeatureGoals& goals = *services.store().session().goals;
        const auto goal = goals.find(services.scene().tf.features[static_cast<std::size_t>(f)].id);
        return goal == goals.end() ? FeatureGoal() : goal->second;
    };
    auto* const gap = new QAction(&actions);
    gap->setSeparator(true);
    m_entries << gap;
    m_entries << actions.add(targetMenu(), "targetLock", QObject::tr("&Lock target"), {},
                             QObject::tr("The selected feature's target stays where others are set (L in the bars)"),
                             [&services, goalOf] {
                                 const int f = services.selectedFeature();
                                 if (f >= 0) setTargetLocked(services.store(), f, !goalOf(f).targetLocked);
                             },
                             selected,
                             {.checked =
                                  [&services, goalOf] {
                                      const int f = services.selectedFeature();
                                      return f >= 0 && goalOf(f).targetLocked;
                                  },
                              .separatorBefore = true});
    add(
        "targetsUnlock", QObject::tr("&Unlock all"), QObject::tr("No target is locked; shares stay as they are"),
        [&services] {
            services.store().commit();
            services.store().edit(QObject::tr("Unlock targets"), {},
                                  [tf = services.scene().wantedTf()](Session& session) {
                                      for (std::size_t i = 0; i < tf.features.size(); ++i)
                                          session.goals.set(withTargetLocked(*session.goals, tf, i, false));
                                  });
        },
        editable);
    const QString menu = QObject::tr("&Transfer function") + "/" + QObject::tr("Feat&ure");
    m_limits << actions.add(menu, "opacityLock", QObject::tr("Loc&k opacity"), {},
                            QObject::tr("Optimize leaves the opacity of the selected feature as it is"),
                            [&services] {
                                const int f = services.selectedFeature();
                                if (f < 0) return;
                                OpacityLimits limits = opacityLimits(services.store(), f);
                                limits.locked = !limits.locked;
                                editOpacityLimits(services.store(), f, limits,
                                                  limits.locked ? QObject::tr("Lock opacity")
                                                                : QObject::tr("Unlock opacity"));
                            },
                            selected,
                            {.checked =
                                 [&services, goalOf] {
                                     const int f = services.selectedFeature();
                                     return f >= 0 && goalOf(f).locked;
                                 },
                             .separatorBefore = true});
    m_limits << actions.add(
        menu, "opacityLimits", QObject::tr("L&imits of opacity…"), {},
        QObject::tr("Between which opacities Optimize may move the selected feature"),
        [&services] {
            if (const int f = services.selectedFeature(); f >= 0) askLimits(services, f);
        },
        selected);
    QObject::connect(&services.store(), &SessionStore::changed, &actions,
                     [&actions](const Scene& before, const Scene& after) {
                         if (!before.session.goals.isSame(after.session.goals) ||
                             before.session.holdTargets != after.session.holdTargets)
                             actions.refresh();
                     });
    QObject::connect(&services.results(), &Results::changed, &actions, [&actions, &services, was = false]() mutable {
        if (was != services.results().vwsIsCurrent()) actions.refresh();
        was = services.results().vwsIsCurrent();
    });
}

} // namespace pellucid::gui
