#include "controllers/target_actions.h"

#include <algorithm>

#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QMenu>

#include "controllers/feature_actions.h"
#include "services/workbench.h"
#include "session/target_presets.h"
#include "store/edits.h"

namespace pellucid::gui {
namespace {

constexpr const char* kEntries[] = {"targetsEqual",    "targetsDiagonal",  "targetsAsNow",
                                    "targetsOnlyThis", "targetsInsideOut", "",
                                    "targetLock",      "targetsUnlock"};

QString targetMenu() { return QObject::tr("&Transfer function") + "/" + QObject::tr("Tar&gets"); }

void setTargets(Workbench& bench, const QString& text, const std::vector<double>& targets) {
    bench.store().commit();
    editTargets(bench.store(), targets, text);
}

void setPreset(Workbench& bench, const QString& text, TargetPreset preset) {
    setTargets(bench, text, presetTargets(preset, bench.scene().wantedTf(), *bench.scene().session.goals));
}

/// Lowest and highest opacity of a feature.
void askLimits(Workbench& bench, int feature) {
    const OpacityLimits limits = opacityLimits(bench.store(), feature);
    QDialog dialog(bench.window());
    dialog.setObjectName("limitsDialog");
    dialog.setWindowTitle(QObject::tr("Limits of the opacity"));
    auto* form = new QFormLayout(&dialog);
    const QString name = QString::fromStdString(bench.scene().tf.features.at(static_cast<std::size_t>(feature)).name);
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
    editOpacityLimits(bench.store(), feature, {lowest->value(), highest->value(), limits.locked},
                      QObject::tr("Limits of opacity"));
}

} // namespace

void addTargetActions(Workbench& bench) {
    Actions& actions = bench.actions();
    const auto editable = [&bench] {
        return bench.store().hasVolume() && !bench.isReadOnly() && !bench.scene().tf.features.empty();
    };
    const auto selected = [&bench, editable] {
        const int f = selectedFeature(bench);
        return editable() && f >= 0 && !bench.scene().wantedTf().features[static_cast<std::size_t>(f)].hidden;
    };
    const auto add = [&](const char* id, const QString& text, const QString& tip, auto trigger, auto enabled) {
        actions.add({.id = id, .menu = targetMenu(), .text = text, .tip = tip, .trigger = trigger, .enabled = enabled});
    };
    add(
        "targetsEqual", QObject::tr("&Equal"), QObject::tr("The same share for each feature; locked targets stay"),
        [&bench] { setPreset(bench, QObject::tr("Equal targets"), TargetPreset::Equal); }, editable);
    add(
        "targetsDiagonal", QObject::tr("&Diagonal"),
        QObject::tr("In proportion to the value at each feature's peak; locked targets stay"),
        [&bench] { setPreset(bench, QObject::tr("Diagonal targets"), TargetPreset::Diagonal); }, editable);
    add(
        "targetsAsNow", QObject::tr("&As now"),
        QObject::tr("The VWS that each feature has now: what the picture shows is what is wanted"),
        [&bench] {
            std::vector<double> vws;
            for (const FeatureMeasures& f : bench.results().measures()->features) vws.push_back(f.vws);
            setTargets(bench, QObject::tr("Targets as now"),
                       targetsByWeights(bench.scene().wantedTf(), *bench.scene().session.goals, vws));
        },
        [&bench, editable] { return editable() && bench.results().vwsIsCurrent(); });
    add(
        "targetsOnlyThis", QObject::tr("&Only this one"),
        QObject::tr("All for the selected feature, as far as locked targets leave it"),
        [&bench] {
            setTargets(bench, QObject::tr("Target of one feature"),
                       targetsForOne(bench.scene().wantedTf(), *bench.scene().session.goals,
                                     static_cast<std::size_t>(selectedFeature(bench))));
        },
        selected);
    add(
        "targetsInsideOut", QObject::tr("&Inside out"),
        QObject::tr("The targets in reverse order; where they are all equal, Diagonal in reverse order"),
        [&bench] { setPreset(bench, QObject::tr("Targets inside out"), TargetPreset::InsideOut); }, editable);
    const auto goalOf = [&bench](int f) {
        const FeatureGoals& goals = *bench.store().session().goals;
        const auto goal = goals.find(bench.scene().tf.features[static_cast<std::size_t>(f)].id);
        return goal == goals.end() ? FeatureGoal() : goal->second;
    };
    actions.add({.id = "targetLock",
                 .menu = targetMenu(),
                 .text = QObject::tr("&Lock target"),
                 .tip = QObject::tr("The selected feature's target stays where others are set (L in the bars)"),
                 .trigger =
                     [&bench, goalOf] {
                         const int f = selectedFeature(bench);
                         if (f >= 0) setTargetLocked(bench.store(), f, !goalOf(f).targetLocked);
                     },
                 .enabled = selected,
                 .checked =
                     [&bench, goalOf] {
                         const int f = selectedFeature(bench);
                         return f >= 0 && goalOf(f).targetLocked;
                     },
                 .separatorBefore = true});
    add(
        "targetsUnlock", QObject::tr("&Unlock all"), QObject::tr("No target is locked; shares stay as they are"),
        [&bench] {
            bench.store().commit();
            bench.store().edit(QObject::tr("Unlock targets"), {}, [tf = bench.scene().wantedTf()](Session& session) {
                for (std::size_t i = 0; i < tf.features.size(); ++i)
                    session.goals.set(withTargetLocked(*session.goals, tf, i, false));
            });
        },
        editable);
    const QString menu = QObject::tr("&Transfer function") + "/" + QObject::tr("Feat&ure");
    actions.add({.id = "opacityLock",
                 .menu = menu,
                 .text = QObject::tr("Loc&k opacity"),
                 .tip = QObject::tr("Optimize leaves the opacity of the selected feature as it is"),
                 .trigger =
                     [&bench] {
                         const int f = selectedFeature(bench);
                         if (f < 0) return;
                         OpacityLimits limits = opacityLimits(bench.store(), f);
                         limits.locked = !limits.locked;
                         editOpacityLimits(bench.store(), f, limits,
                                           limits.locked ? QObject::tr("Lock opacity") : QObject::tr("Unlock opacity"));
                     },
                 .enabled = selected,
                 .checked =
                     [&bench, goalOf] {
                         const int f = selectedFeature(bench);
                         return f >= 0 && goalOf(f).locked;
                     },
                 .separatorBefore = true});
    actions.add({.id = "opacityLimits",
                 .menu = menu,
                 .text = QObject::tr("L&imits of opacity…"),
                 .tip = QObject::tr("Between which opacities Optimize may move the selected feature"),
                 .trigger =
                     [&bench] {
                         if (const int f = selectedFeature(bench); f >= 0) askLimits(bench, f);
                     },
                 .enabled = selected});
    QObject::connect(&bench.store(), &SessionStore::changed, &actions,
                     [&actions](const Scene& before, const Scene& after) {
                         if (!before.session.goals.isSame(after.session.goals) ||
                             before.session.holdTargets != after.session.holdTargets)
                             actions.refresh();
                     });
    QObject::connect(&bench.results(), &Results::changed, &actions, [&actions, &bench, was = false]() mutable {
        if (was != bench.results().vwsIsCurrent()) actions.refresh();
        was = bench.results().vwsIsCurrent();
    });
}

void fillTargetMenu(QMenu& menu, Workbench& bench) {
    menu.setToolTipsVisible(true);
    for (const char* id : kEntries) {
        if (*id == 0)
            menu.addSeparator();
        else
            menu.addAction(bench.actions().find(id));
    }
}

void fillLimitsMenu(QMenu& menu, Workbench& bench) {
    menu.addSeparator();
    for (const char* id : {"opacityLock", "opacityLimits"}) menu.addAction(bench.actions().find(id));
}

} // namespace pellucid::gui
