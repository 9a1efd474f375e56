#include "panels/variable_words.h"

#include <QWidget>

#include "dialogs/series_files.h"
#include "services/services.h"
#include "session/variable_edits.h"

namespace pellucid::gui {
namespace {

QString derivationText(const Derivation& d, const QString& of) {
    switch (d.kind) {
    case Derivation::Kind::Gradient:
        return QObject::tr("gradient of %1").arg(of);
    case Derivation::Kind::Volatility:
        return QObject::tr("volatility of %1, %L2 frames").arg(of).arg(d.frames);
    case Derivation::Kind::Difference:
        return QObject::tr("%1 less its frame %L2").arg(of).arg(d.reference);
    }
    return of;
}

} // namespace

QString originText(const Variable& variable) {
    if (variable.derivation)
        return derivationText(*variable.derivation, QString::fromStdString(variable.derivation->of));
    const QString array = QString::fromStdString(variable.source.array);
    return array.isEmpty() ? titleOf(variable.source) : QStringLiteral("%1 ▸ %2").arg(titleOf(variable.source), array);
}

QString driverText(const Session& session, const std::string& name) {
    if (session.variableNamed(name) == nullptr)
        if (const auto derivation = parseDerivation(name))
            return derivationText(*derivation, driverText(session, derivation->of));
    return QString::fromStdString(name);
}

QString featuresText(const Session& session, const std::string& name) {
    const Variable* const variable = session.variableNamed(name);
    if (variable == nullptr || !variable->derivation) return driverText(session, name);
    const QString made = derivationText(*variable->derivation, driverText(session, variable->derivation->of));
    return made.startsWith(QString::fromStdString(name))
               ? made
               : QStringLiteral("%1 (%2)").arg(driverText(session, name), made);
}

QString curveTitle(const Session& session) {
    const QString title = QObject::tr("Transfer function");
    const HsbMapping& hsb = *session.hsb;
    if (session.isEmpty() || (!hsb.on && session.variables->size() < 2)) return title;
    const QString of = QObject::tr("%1 of %2").arg(title, QString::fromStdString(session.variable().name));
    if (!hsb.on) return of;
    QStringList channels;
    const std::pair<QString, const std::string&> driven[] = {{QObject::tr("saturation"), hsb.saturation},
                                                             {QObject::tr("brightness"), hsb.brightness},
                                                             {QObject::tr("hue"), hsb.hue}};
    for (const auto& [channel, name] : driven)
        if (!name.empty()) channels << QStringLiteral("%1 ← %2").arg(channel, driverText(session, name));
    return QObject::tr("%1: opacity alone, colours come from variables (%2)")
        .arg(of, channels.isEmpty() ? QObject::tr("one hue") : channels.join(", "));
}

QString featuresTitle(const Session& session) {
    if (session.isEmpty() || (!session.hsb->on && session.variables->size() < 2)) return QObject::tr("Features");
    return QObject::tr("Features of %1").arg(QString::fromStdString(session.variable().name));
}

void followTitle(Services& services, QWidget* dock, QString (*title)(const Session&)) {
    QObject::connect(&services.store(), &SessionStore::changed, dock,
                     [dock, title](const Scene& before, const Scene& after) {
                         if (!before.session.variables.isSame(after.session.variables) ||
                             !before.session.hsb.isSame(after.session.hsb))
                             dock->setWindowTitle(title(after.session));
                     });
}

} // namespace pellucid::gui
