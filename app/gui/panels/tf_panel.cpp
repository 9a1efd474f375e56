#include <QMenu>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/variable_words.h"
#include "services/services.h"
#include "tf/ghost_layer.h"
#include "tf/palette_bar.h"
#include "tf/shapes.h"
#include "tf/tf_editor_widget.h"
#include "widgets/dock_title.h"

namespace pellucid::gui {
namespace {

/// What can be done to the feature under the mouse, which is selected for it.
void addFeatureMenu(QMenu& menu, Services& services, const FeatureActions& actions, FeatureId id) {
    const int feature = featureWithId(services.scene().tf, id);
    if (feature < 0) return menu.addMenu(QObject::tr("Add feature"))->addActions(actions.shapes());
    services.selection().setFeature(id);
    const std::string& name = services.scene().tf.features[static_cast<std::size_t>(feature)].name;
    const bool onBar = menu.isEmpty();
    actions.fillMenu(onBar ? menu : *menu.addMenu(QObject::tr("Feature %1").arg(QString::fromStdString(name))));
}

} // namespace

PanelInfo transferFunctionPanel() {
    return {.id = "tf",
            .title = QObject::tr("Transfer function"),
            .area = Qt::BottomDockWidgetArea,
            .keys = QKeySequence("Ctrl+1"),
            .tip = QObject::tr("The curve of opacity and colour over the histogram"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                auto* editor = new TfEditorWidget(services.store(), services.results(), services.selection(), parent);
                QObject::connect(&services, &Services::readOnlyChanged, editor,
                                 [editor, &services] { editor->setReadOnly(services.isReadOnly()); });
                addGhostLayer(controllers.refining, editor->canvas());
                new PaletteBar(services, controllers.refining, editor->canvas());
                if (DockTitle* const title = DockTitle::of(parent)) editor->fill(title->controls());
                followTitle(services, parent, curveTitle);
                QObject::connect(&editor->canvas(), &TfCanvas::menuOpening, editor,
                                 [&services, &features = controllers.features](QMenu& menu, double, FeatureId id) {
                                     addFeatureMenu(menu, services, features, id);
                                 });
                const QString place = QObject::tr("Transfer function");
                services.actions().addGestures(
                    {{place, QObject::tr("Drag a point (Shift: along one axis, Ctrl: finely)"),
                      QObject::tr("change its value and opacity, and of all that are selected")},
                     {place, QObject::tr("Drag over points, Ctrl+click, Ctrl+A"), QObject::tr("select several")},
                     {place, QObject::tr("Double-click"), QObject::tr("add a point; on a point: its colour")},
                     {place, QObject::tr("Enter, Space, Delete"), QObject::tr("colour, fix, remove the points")},
                     {place, QObject::tr("Arrow keys (Shift: finer)"), QObject::tr("move the points")},
                     {place, QObject::tr("Page Up, Page Down"), QObject::tr("choose another point")},
                     {place, QObject::tr("Drag a feature's bar, its ends"), QObject::tr("move the feature, widen it")},
                     {place, QObject::tr("Wheel; middle drag, Shift + wheel, drag of the axis"),
                      QObject::tr("zoom into the values; move along")},
                     {place, QObject::tr("Double-click on the axis, on a bar"),
                      QObject::tr("see all values, those of the feature")}});
                return editor;
            }};
}

} // namespace pellucid::gui
