#include "services/verdict_choices.h"

#include <cmath>

#include "services/services.h"
#include "store/edits.h"
#include "tf/edit.h"

namespace pellucid::gui {
namespace {

constexpr std::size_t kMostChoices = 3, kMostNumbers = 4; ///< of changes; shares that a button names

/// "42/40/18".
QString sharesText(const std::vector<double>& shares) {
    QStringList numbers;
    for (const double share : shares) numbers << QString::number(std::lround(100 * share));
    return numbers.join('/');
}

QString nameOf(Services& services, std::size_t feature) {
    return QString::fromStdString(services.scene().tf.features.at(feature).name);
}

Notice::Choice choiceOf(Services& services, const ReachHelp& help) {
    SessionStore& store = services.store();
    const int feature = static_cast<int>(help.feature);
    switch (help.kind) {
    case ReachHelp::Kind::Release: {
        const QString text = QObject::tr("Unlock %1").arg(nameOf(services, help.feature));
        return {text, [&store, feature, text] { editOpacityLimits(store, feature, {}, text); }};
    }
    case ReachHelp::Kind::Color: {
        const QString text = QObject::tr("Recolour %1").arg(nameOf(services, help.feature));
        return {text, [&store, feature, text, color = *help.color] {
                    editTf(store, withFeatureColor(store.scene().tf, feature, color), text);
                }};
    }
    case ReachHelp::Kind::Clipping:
        return {QObject::tr("Remove clipping"), [&store] {
                    store.edit(QObject::tr("Remove clipping"), {},
                               [](Session& session) { session.clipping.edit([](Clipping& c) { c.setPart({}); }); });
                }};
    case ReachHelp::Kind::View:
        break;
    }
    return {QObject::tr("Turn there"), [&store, view = *help.view] {
                const Scene& scene = store.scene();
                store.setCamera(cameraFromView(scene.volume->geometry(), view.azimuth, view.elevation, view.zoom,
                                               scene.camera.projection));
            }};
}

} // namespace

std::vector<Notice::Choice> choicesOf(Services& services, const Verdict& verdict, const std::function<void()>& again) {
    const QString use = verdict.vws.size() <= kMostNumbers ? QObject::tr("Use %1 %").arg(sharesText(verdict.vws))
                                                           : QObject::tr("Use what is in reach");
    std::vector<Notice::Choice> choices{{use, [&store = services.store(), shares = verdict.vws] {
                                             store.commit();
                                             editTargets(store, shares, QObject::tr("Targets within reach"));
                                         }}};
    for (const ReachHelp& help : verdict.helps) {
        if (choices.size() > kMostChoices) break;
        Notice::Choice choice = choiceOf(services, help);
        choices.push_back({choice.text, [act = choice.act, again] {
                               act();
                               again();
                           }});
    }
    return choices;
}

} // namespace pellucid::gui
