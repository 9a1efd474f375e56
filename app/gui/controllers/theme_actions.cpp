#include "controllers/menu_actions.h"

#include <QApplication>
#include <QSettings>

#include "services/services.h"

namespace pellucid::gui {
namespace {

const QString kSetting = QStringLiteral("theme");

}

Theme keptTheme() {
    return findNamed<Theme>(QSettings().value(kSetting).toString().toStdString()).value_or(Theme::Dark);
}

void addThemeActions(Services& services) {
    struct Texts {
        Theme theme;
        QString id, text, tip;
    };
    const Texts all[] = {
        {Theme::Dark, "themeDarkAction", QObject::tr("&Dark"), QObject::tr("Dark panels around the picture")},
        {Theme::Light, "themeLightAction", QObject::tr("&Light"), QObject::tr("Light panels around the picture")},
        {Theme::System, "themeSystemAction", QObject::tr("As the &system"),
         QObject::tr("Dark or light, as the desktop is")}};
    for (const Texts& t : all)
        services.actions().add(QObject::tr("&View") + "/" + QObject::tr("&Theme"), t.id, t.text, {}, t.tip,
                               [theme = t.theme] {
                                   QSettings().setValue(kSetting, name(theme));
                                   applyTheme(*qApp, theme);
                               },
                               {}, {.checked = [theme = t.theme] { return appliedTheme() == theme; }});
}

} // namespace pellucid::gui
