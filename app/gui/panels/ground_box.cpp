#include "panels/ground_box.h"

#include <QCheckBox>
#include <QMenu>
#include <QPushButton>

#include <glm/geometric.hpp>

#include "controllers/open_controller.h"
#include "dialogs/series_files.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "tf/terrain.h"
#include "volume/procedural.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

class GroundBox : public QWidget {
public:
    GroundBox(Services& services, OpenController& opening);

private:
    void follow();
    void fillMenu();
    void chooseFile();
    void lay(const VolumeSource& source);

    Services& m_services;
    OpenController& m_opening;
    QCheckBox* m_shown = named(new QCheckBox(tr("&Ground"), this), "groundShown",
                               tr("A height field under the volume; figures do not depend on it"));
    QLabel* m_file = withAnyWidth(named(new ElidedLabel(this), "groundFile"));
    QToolButton* m_choose = named(menuButton(tr("Choose"), this), "groundChoose",
                                  tr("Heights: a volume of one layer, over the whole box of the data"));
    QPushButton* m_remove = named(new QPushButton(tr("Remove"), this), "groundRemove", tr("Take the ground away"));
    QComboBox* m_colorMap =
        named(new QComboBox(this), "groundColorMap", tr("Colours from the lowest to the highest ground"));
};

GroundBox::GroundBox(Services& services, OpenController& opening) : m_services(services), m_opening(opening) {
    setObjectName("groundBox");
    m_file->setTextFormat(Qt::PlainText);
    fillMenu();
    for (const std::string& name : groundColorNames())
        m_colorMap->addItem(QString::fromStdString(name), QString::fromStdString(name));
    auto* form = narrowForm(inset(new QFormLayout(this), {}));
    form->setVerticalSpacing(6);
    form->addRow(rowOf({m_shown, {m_file, 1}}));
    form->addRow(rowOf({m_choose, m_remove, Cell::rest()}));
    form->addRow(tr("Colours"), m_colorMap);
    auto* scale = new SettingRows(m_services, *form, settingPart<GroundView>(&Session::ground));
    scale->setCommit([this](const QString& text, const QString&, const SessionStore::Change& change) {
        m_opening.editInJob(text, change);
    });
    scale->add("scale", {.id = "groundScale",
                         .decimals = 6,
                         .automatic =
                             [this] {
                                 const Scene& scene = m_services.scene();
                                 return scene.ground ? glm::length(scene.ground->up) : 1.0;
                             },
                         .stepText = tr("Scale of the ground")});
    auto* relief = new SettingRows(m_services, *form, settingPart<GroundView>(&Session::ground));
    relief->add("relief", {.id = "groundRelief", .slider = true, .stepText = tr("Relief of the ground")});

    connect(m_shown, &QCheckBox::clicked, this, [this](bool shown) {
        m_opening.editInJob(shown ? tr("Show ground") : tr("Hide ground"),
                            changing(&Session::ground, [shown](GroundView& g) { g.shown = shown; }));
        m_shown->setChecked(m_services.store().session().ground->shown); // until it has been done
    });
    connect(m_remove, &QPushButton::clicked, this,
            [this] { m_services.store().edit(tr("Remove ground"), {}, [](Session& s) { s.ground.set({}); }); });
    connect(m_colorMap, &QComboBox::activated, this, [this] {
        const std::string name = m_colorMap->currentData().toString().toStdString();
        editPart(m_services.store(), &Session::ground, tr("Colours of the ground"), {},
                 [name](GroundView& g) { g.colorMap = name; });
    });
    connect(&m_services.store(), &SessionStore::changed, this, [=, this](const Scene& before, const Scene& after) {
        if (before.ground == after.ground) return;
        scale->follow(); // what "auto" stands for
        follow();
    });
    scale->follow();
    relief->follow();
    followParts(
        m_services, this, [this] { follow(); }, &Session::ground);
}

void GroundBox::fillMenu() {
    QMenu& menu = *m_choose->menu();
    menu.setObjectName("groundMenu");
    menu.addAction(tr("File…"), this, &GroundBox::chooseFile)->setObjectName("groundFileAction");
    menu.addSeparator();
    for (const SampleInfo& sample : samples()) {
        if (sample.defaultDims.z != 1) continue;
        const QString name = QString::fromStdString(sample.name);
        QAction* action = menu.addAction(tr("Sample %1").arg(name), this, [this, name] {
            VolumeSource source;
            source.path = "sample:" + name.toStdString();
            lay(source);
        });
        action->setObjectName("ground_" + name);
    }
}

void GroundBox::chooseFile() {
    if (const auto source = m_opening.askSource(tr("Heights of the ground"))) lay(*source);
}

void GroundBox::lay(const VolumeSource& source) {
    m_opening.editInJob(tr("Ground %1").arg(titleOf(source)), changing(&Session::ground, [source](GroundView& g) {
                            g.path = source.path;
                            g.raw = source.raw;
                            g.missing = source.missing;
                            g.scale.reset();
                            g.shown = true;
                        }));
}

void GroundBox::follow() {
    setEnabled(m_services.isEditable());
    const Scene& scene = m_services.scene();
    const GroundView& view = *scene.session.ground;
    const bool any = !view.path.empty();
    VolumeSource source;
    source.path = view.path;
    m_file->setText(any ? titleOf(source) : tr("none"));
    m_file->setToolTip(QString::fromStdString(view.path));
    m_shown->setChecked(any && view.shown);
    const QString map = QString::fromStdString(view.colorMap);
    if (m_colorMap->findData(map) < 0) m_colorMap->addItem(map, map);
    m_colorMap->setCurrentIndex(m_colorMap->findData(map));
    m_shown->setEnabled(any);
    m_remove->setEnabled(any);
    m_colorMap->setEnabled(any && view.shown);
}

} // namespace

QWidget* makeGroundBox(Services& services, OpenController& opening) { return new GroundBox(services, opening); }

} // namespace pellucid::gui
