#include "controllers/menu_actions.h"

#include "services/services.h"
#include "store/edits.h"
#include "tf/transfer_function.h"

namespace pellucid::gui {
namespace {

QString menuName() { return QObject::tr("&Transfer function"); }

} // namespace

void addTfActions(Services& services) {
    Actions& actions = services.actions();
    const auto editable = [&services] { return services.isEditable(); };
    const QString presets = menuName() + "/" + QObject::tr("&Presets");
    for (const char* spec : {"tents:1", "tents:2", "tents:3", "tents:4", "tents:6", "tents:8", "ramp:6", "ramp:12"}) {
        const QString name = QString::fromLatin1(spec);
        const QString number = name.section(':', 1);
        const QString text = name.startsWith("tents")
                                 ? (number == "1" ? QObject::tr("One tent, one feature")
                                                  : QObject::tr("%1 tents, one feature each").arg(number))
                                 : QObject::tr("Ramp of %1 points, one feature").arg(number);
        actions.add(
            presets, name, text, {}, {},
            [&services, name] { editTf(services.store(), *tfFromSpec(name.toStdString()), name); }, editable);
    }
    actions.add(menuName(), "deriveFeaturesAction", QObject::tr("&Features from the curve"), {},
                QObject::tr("One feature for each interval of the curve between two points of opacity 0"),
                [&services] {
                    TransferFunction tf = services.scene().tf;
                    tf.features = deriveFeatures(tf);
                    editTf(services.store(), tf, QObject::tr("Features from the curve"));
                },
                editable, {.separatorBefore = true});
}

} // namespace pellucid::gui
