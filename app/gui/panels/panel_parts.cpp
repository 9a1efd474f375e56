#include "panels/panel_parts.h"

#include <QAction>
#include <QComboBox>
#include <QDir>
#include <QPainter>

#include "base/atomic_file.h"
#include "dialogs/ask_file.h"
#include "tf/color_maps.h"
#include "widgets/controls.h"
#include "widgets/plot_view.h"
#include "widgets/theme.h"

namespace pellucid::gui {

namespace {

QIcon iconOf(const ColorMap& map) {
    QPixmap pixmap(48, 12);
    QPainter painter(&pixmap);
    for (int x = 0; x < pixmap.width(); ++x)
        painter.fillRect(x, 0, 1, pixmap.height(), colorFromRgb(map.colorAt((x + 0.5) / pixmap.width())));
    return pixmap;
}

} // namespace

QToolButton* actionButton(QAction& does, const char* name, const QString& text, QWidget* parent) {
    QToolButton* const made = named(toolButton(text, parent), name, does.toolTip());
    made->setAccessibleName(does.toolTip());
    made->setCheckable(does.isCheckable());
    const auto followAction = [made, &does] {
        made->setEnabled(does.isEnabled());
        made->setChecked(does.isChecked());
    };
    QObject::connect(made, &QToolButton::clicked, &does, [&does, followAction] {
        does.trigger();
        followAction(); // a click has checked it by itself
    });
    QObject::connect(&does, &QAction::changed, made, followAction);
    followAction();
    return made;
}

void fillFeatures(QComboBox& box, const Scene& scene, const QString& all, int present) {
    box.clear();
    box.addItem(all, QVariant::fromValue<qulonglong>(0));
    for (const Feature& f : scene.tf.features)
        box.addItem(swatchOf(colorFromRgb(f.color), 12, 12), QString::fromStdString(f.name),
                    QVariant::fromValue<qulonglong>(f.id));
    box.setCurrentIndex(present + 1);
}

void addColorMaps(QComboBox& box) {
    box.setIconSize({48, 12});
    for (const ColorMap& map : colorMaps()) {
        if (map.kind == ColorMap::Kind::Categorical) continue;
        const QString name = QString::fromStdString(map.name);
        addItem(box, name, name, QString::fromStdString(map.title));
        box.setItemIcon(box.count() - 1, iconOf(map));
    }
}

FeatureId chosenFeature(const QComboBox& box) { return static_cast<FeatureId>(box.currentData().toULongLong()); }

QString askCurveFile(Services& services, const QString& title, const QString& name, const QString& suffix) {
    const std::pair<QString, QString> kinds[] = {{"csv", QObject::tr("Table (*.csv)")},
                                                 {"png", QObject::tr("Picture (*.png)")},
                                                 {"svg", QObject::tr("Drawing (*.svg)")}};
    QStringList filters;
    for (const auto& [kind, filter] : kinds)
        if (suffix.isEmpty() || suffix == kind) filters << filter;
    const QString usual = "." + (suffix.isEmpty() ? kinds[0].first : suffix);
    const QString folder = keptFolder("curvesFolder", QDir::homePath());
    QString path =
        QFileDialog::getSaveFileName(services.window(), title, QDir(folder).filePath(name + usual), filters.join(";;"));
    if (path.isEmpty()) return {};
    if (QFileInfo(path).suffix().isEmpty()) path += usual;
    keepFolderOf("curvesFolder", path);
    return path;
}

void exportCurves(Services& services, const QString& path, const std::function<std::string()>& table,
                  const std::function<std::vector<Plot>()>& plots) {
    const QFileInfo file(path);
    try {
        if (file.suffix().toLower() == "csv")
            writeTextAtomically(path.toStdString(), table());
        else
            writePlots(path.toStdString(), plots());
        services.saySaved(path);
    } catch (const Error& error) {
        services.showError(QObject::tr("Cannot export the curves"), error);
    }
}

} // namespace pellucid::gui
