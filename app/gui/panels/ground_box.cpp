#include "panels/ground_box.h"

#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QSlider>
#include <QToolButton>

#include <glm/geometric.hpp>

#include "controllers/open_controller.h"
#include "dialogs/series_files.h"
#include "services/services.h"
#include "tf/terrain.h"
#include "volume/procedural.h"
#include "widgets/number_box.h"

namespace pellucid::gui {
namespace {

constexpr int kReliefSteps = 100;

} // namespace

GroundBox::GroundBox(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening), m_file(new QLabel(this)),
      m_choose(new QToolButton(this)), m_remove(new QPushButton(tr("Remove"), this)),
      m_shown(new QCheckBox(tr("&Ground"), this)), m_colorMap(new QComboBox(this)), m_scale(new QDoubleSpinBox(this)),
      m_relief(new QDoubleSpinBox(this)), m_usualScale(new QToolButton(this)),
      m_reliefSlider(new QSlider(Qt::Horizontal, this)) {
    setObjectName("groundBox");
    m_shown->setObjectName("groundShown");
    m_shown->setToolTip(tr("A height field under the volume; figures do not depend on it"));
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
    m_remove->setObjectName("groundRemove");
    m_remove->setToolTip(tr("No ground"));
    m_colorMap->setObjectName("groundColorMap");
    m_colorMap->setToolTip(tr("Colours from the lowest to the highest ground"));
    for (const std::string& name : groundColorNames())
        m_colorMap->addItem(QString::fromStdString(name), QString::fromStdString(name));
    m_scale->setObjectName("groundScale");
    m_scale->setRange(-1e9, 1e9);
    m_scale->setDecimals(4);
    m_scale->setMinimumWidth(60);
    m_scale->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    m_scale->setKeyboardTracking(false);
    m_scale->setToolTip(tr("Length in the world of one unit of height"));
    m_usualScale->setObjectName("groundUsualScale");
    m_usualScale->setText(tr("auto"));
    m_usualScale->setCheckable(true);
    m_usualScale->setToolTip(tr("As the heights are where they fit the box, else the highest to a tenth of it"));
    m_relief->setObjectName("groundRelief");
    m_relief->setRange(0, 1);
    m_relief->setDecimals(2);
    m_relief->setSingleStep(0.05);
    m_relief->setKeyboardTracking(false);
    m_reliefSlider->setObjectName("groundReliefSlider");
    m_reliefSlider->setRange(0, kReliefSteps);
    m_reliefSlider->setMinimumWidth(60);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_relief, m_reliefSlider})
        widget->setToolTip(tr("How strongly slopes are shaded, 0 (not at all) to 1"));

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
    auto* scale = new QHBoxLayout;
    scale->addWidget(m_scale, 1);
    scale->addWidget(m_usualScale);
    form->addRow(tr("Scale"), scale);
    auto* relief = new QHBoxLayout;
    relief->addWidget(m_reliefSlider, 1);
    relief->addWidget(m_relief);
    form->addRow(tr("Relief"), relief);

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
    const auto setScale = [this](const std::optional<double>& value) {
        m_opening.editInJob(tr("Scale of the ground"), [value](Session& session) {
            session.ground.edit([&](GroundView& g) { g.scale = value; });
        });
    };
    connect(m_scale, &QDoubleSpinBox::valueChanged, this, [this, setScale](double value) {
        if (!m_showing) setScale(value);
    });
    connect(m_usualScale, &QToolButton::clicked, this,
            [this, setScale](bool usual) { setScale(usual ? std::nullopt : std::optional(m_scale->value())); });
    connect(m_relief, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        edit(tr("Relief of the ground"), "ground-relief", [value](GroundView& g) { g.relief = value; });
    });
    connect(m_reliefSlider, &QSlider::valueChanged, this, [this](int position) {
        if (m_showing) return;
        const auto change = [value = static_cast<double>(position) / kReliefSteps](GroundView& g) { g.relief = value; };
        if (m_reliefSlider->isSliderDown())
            m_services.store().preview(tr("Relief of the ground"),
                                       [&](Session& session) { session.ground.edit(change); });
        else
            edit(tr("Relief of the ground"), "ground-relief", change); // by keys
    });
    connect(m_reliefSlider, &QSlider::sliderReleased, this, [this] { m_services.store().commit(); });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || before.ground != after.ground ||
            !before.session.ground.isSame(after.session.ground))
            follow();
    });
    connect(&m_services, &Services::readOnlyChanged, this, &GroundBox::follow);
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
    if (m_showing) return;
    m_services.store().edit(text, mergeKey, [&](Session& session) { session.ground.edit(change); });
}

void GroundBox::follow() {
    setEnabled(m_services.isEditable());
    const Scene& scene = m_services.scene();
    const GroundView& view = *scene.session.ground;
    const bool any = !view.path.empty();
    m_showing = true;
    VolumeSource source;
    source.path = view.path;
    m_file->setText(any ? titleOf(source) : tr("none"));
    m_file->setToolTip(QString::fromStdString(view.path));
    m_shown->setChecked(any && view.shown);
    showNumber(*m_scale, view.scale.value_or(scene.ground ? glm::length(scene.ground->up) : 1.0));
    m_usualScale->setChecked(!view.scale);
    showNumber(*m_relief, view.relief);
    if (!m_reliefSlider->isSliderDown())
        m_reliefSlider->setValue(static_cast<int>(std::lround(view.relief * kReliefSteps)));
    const QString map = QString::fromStdString(view.colorMap);
    if (m_colorMap->findData(map) < 0) m_colorMap->addItem(map, map);
    m_colorMap->setCurrentIndex(m_colorMap->findData(map));
    m_shown->setEnabled(any);
    m_remove->setEnabled(any);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_colorMap, m_scale, m_usualScale, m_relief, m_reliefSlider})
        widget->setEnabled(any && view.shown);
    m_showing = false;
}

} // namespace pellucid::gui
