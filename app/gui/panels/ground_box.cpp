#include "panels/ground_box.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>

#include <glm/geometric.hpp>

#include "controllers/open_controller.h"
#include "dialogs/series_files.h"
#include "panels/setting_rows.h"
#include "services/services.h"
#include "tf/terrain.h"
#include "volume/procedural.h"
#include "widgets/named.h"

namespace pellucid::gui {
GroundBox::GroundBox(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening), m_file(new QLabel(this)),
      m_choose(new QToolButton(this)), m_remove(new QPushButton(tr("Remove"), this)),
      m_shown(new QCheckBox(tr("&Ground"), this)), m_colorMap(new QComboBox(this)) {
    setObjectName("groundBox");
    named(m_shown, "groundShown", tr("A height field under the volume; figures do not depend on it"));
    m_file->setObjectName("groundFile");
    m_file->setTextFormat(Qt::PlainText);
    m_file->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    m_choose->setObjectName("groundChoose");
    m_choose->setText(tr("Choose"));
    m_choose->setPopupMode(QToolButton::InstantPopup);
    m_choose->setToolTip(tr("Heights: a volume of one layer, over the whole box of the data"));
    auto* menu = new QMenu(m_choose);
    menu->setObjectName("groundMenu");
    menu->addAction(tr("File…"), this, &GroundBox::chooseFile)->setObjectName("groundFileAction");
    menu->addSeparator();
    for (const SampleInfo& sample : samples()) {
        if (sample.defaultDims.z != 1) continue;
        const QString name = QString::fromStdString(sample.name);
        QAction* action = menu->addAction(tr("Sample %1").arg(name), this, [this, name] {
            VolumeSource source;
            source.path = "sample:" + name.toStdString();
            lay(source);
        });
        action->setObjectName("ground_" + name);
    }
    m_choose->setMenu(menu);
    named(m_remove, "groundRemove", tr("No ground"));
    named(m_colorMap, "groundColorMap", tr("Colours from the lowest to the highest ground"));
    for (const std::string& name : groundColorNames())
        m_colorMap->addItem(QString::fromStdString(name), QString::fromStdString(name));
    auto* form = new QFormLayout(this);
    form->setContentsMargins(0, 0, 0, 0);
    form->setVerticalSpacing(6);
    auto* head = new QHBoxLayout;
    head->addWidget(m_shown);
    head->addWidget(m_file, 1);
    head->addWidget(m_choose);
    head->addWidget(m_remove);
    form->addRow(head);
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
        m_opening.editInJob(shown ? tr("Show ground") : tr("Hide ground"), [shown](Session& session) {
            session.ground.edit([shown](GroundView& g) { g.shown = shown; });
        });
        m_shown->setChecked(m_services.store().session().ground->shown); // until it has been done
    });
    connect(m_remove, &QPushButton::clicked, this,
            [this] { edit(tr("Remove ground"), {}, [](GroundView& g) { g = {}; }); });
    connect(m_colorMap, &QComboBox::activated, this, [this] {
        edit(tr("Colours of the ground"), {},
             [name = m_colorMap->currentData().toString().toStdString()](GroundView& g) { g.colorMap = name; });
    });
    connect(&m_services.store(), &SessionStore::changed, this, [=, this](const Scene& before, const Scene& after) {
        if (before.ground != after.ground) scale->follow(); // what "auto" stands for
        if (before.volume != after.volume || before.ground != after.ground ||
            !before.session.ground.isSame(after.session.ground))
            follow();
    });
    connect(&m_services, &Services::readOnlyChanged, this, &GroundBox::follow);
    scale->follow();
    relief->follow();
    follow();
}

void GroundBox::chooseFile() {
    if (const auto source = m_opening.askSource(tr("Heights of the ground"))) lay(*source);
}

void GroundBox::lay(const VolumeSource& source) {
    m_opening.editInJob(tr("Ground %1").arg(titleOf(source)), [source](Session& session) {
        session.ground.edit([&](GroundView& g) {
            g.path = source.path;
            g.raw = source.raw;
            g.missing = source.missing;
            g.scale.reset();
            g.shown = true;
        });
    });
}

void GroundBox::edit(const QString& text, const QString& mergeKey, const Change& change) {
    m_services.store().edit(text, mergeKey, [&](Session& session) { session.ground.edit(change); });
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

} // namespace pellucid::gui
