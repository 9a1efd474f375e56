#include "panels/light_panel.h"

#include <cmath>
#include <numbers>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSignalBlocker>

#include <glm/geometric.hpp>

#include "panels/panel.h"
#include "panels/setting_rows.h"
#include "render/light_presets.h"
#include "services/services.h"
#include "widgets/named.h"
#include "widgets/number_box.h"
#include "widgets/scrolled.h"

namespace pellucid::gui {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

bool isReady(Services& services) { return services.isEditable(); }

} // namespace

LightPanel::LightPanel(Services& services, QAction& light, QWidget* parent)
    : QWidget(parent), m_services(services), m_on(new QCheckBox(tr("&Light"), this)), m_preset(new QComboBox(this)),
      m_right(new QDoubleSpinBox(this)), m_up(new QDoubleSpinBox(this)),
      m_fromEye(new QPushButton(tr("From the &eye"), this)) {
    setObjectName("lightPanel");
    named(m_on, "shadingCheck", tr("Light by the gradient of the values; figures do not depend on it (L)"));
    named(m_preset, "lightPresetCombo", tr("Ready-made light; where it comes from stays"));
    for (const LightPreset& preset : lightPresets()) {
        m_preset->addItem(QString::fromLatin1(preset.name));
        m_preset->setItemData(m_preset->count() - 1, QString::fromLatin1(preset.description), Qt::ToolTipRole);
    }
    m_preset->setPlaceholderText(tr("own"));
    named(m_fromEye, "lightFromEyeButton",
          tr("The light goes with the viewer; drag in the picture with Ctrl held to turn it"));

    auto* content = new QWidget;
    auto* form = new QFormLayout(content);
    form->setContentsMargins(10, 8, 10, 8);
    form->setVerticalSpacing(6);
    auto* head = new QHBoxLayout;
    head->addWidget(m_on);
    head->addWidget(m_preset, 1);
    form->addRow(head);
    auto* rows = new SettingRows(m_services, *form, settingPart<Light>(&Session::display, &DisplaySettings::light));
    rows->add("ambient", {.id = "lightAmbient", .slider = true});
    rows->add("diffuse", {.id = "lightDiffuse", .slider = true});
    rows->add("specular", {.id = "lightSpecular", .slider = true});
    rows->add("shininess", {.id = "lightShininess", .slider = true, .logarithmic = true, .decimals = 0, .step = 1});
    addDirection(*form);
    rows->add("silhouettes", {.id = "lightSilhouettes", .slider = true});
    rows->add("occlusion", {.id = "lightOcclusion", .slider = true});
    rows->add("depth_cue", {.id = "lightDepthCue", .slider = true});
    rows->add("gradient_opacity", {.id = "lightGradientOpacity", .slider = true});
    rows->follow();
    fillScrolled(this, content);

    SessionStore& store = m_services.store();
    connect(m_on, &QCheckBox::clicked, &light, &QAction::trigger);
    connect(m_preset, &QComboBox::activated, this, [this](int index) {
        const LightPreset& preset = lightPresets()[static_cast<std::size_t>(index)];
        m_services.store().edit(tr("Light: %1").arg(QString::fromLatin1(preset.name)), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) { d.light = withPreset(d.light, preset); });
        });
    });
    connect(m_fromEye, &QPushButton::clicked, this, [this] {
        m_services.store().edit(tr("Light from the eye"), {}, [](Session& session) {
            session.display.edit([](DisplaySettings& d) { d.light.direction = Light{}.direction; });
        });
    });
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !before.session.display.isSame(after.session.display)) follow();
    });
    connect(&m_services, &Services::readOnlyChanged, this, &LightPanel::follow);
    follow();
}

void LightPanel::addDirection(QFormLayout& form) {
    const std::pair<QDoubleSpinBox*, const char*> angles[] = {{m_right, "lightRight"}, {m_up, "lightUp"}};
    auto* from = new QHBoxLayout;
    for (const auto& [box, name] : angles) {
        box->setObjectName(name);
        box->setDecimals(0);
        box->setSuffix(tr("°"));
        box->setSingleStep(5);
        box->setKeyboardTracking(false);
        from->addWidget(box, 1);
        connect(box, &QDoubleSpinBox::valueChanged, this, &LightPanel::editDirection);
    }
    m_right->setRange(-180, 180);
    m_right->setToolTip(tr("How far from the right the light comes, degrees; 0 is from the eye"));
    m_up->setRange(-90, 90);
    m_up->setToolTip(tr("How far from above the light comes, degrees; 0 is from the eye"));
    form.addRow(tr("From"), from);
    form.addRow(QString(), m_fromEye);
}

void LightPanel::editDirection() {
    const double right = m_right->value() / kDegrees, up = m_up->value() / kDegrees;
    const Vec3 direction{std::sin(right) * std::cos(up), std::sin(up), std::cos(right) * std::cos(up)};
    m_services.store().edit(tr("Light's direction"), "lightDirection", [&](Session& session) {
        session.display.edit([&](DisplaySettings& d) { d.light.direction = direction; });
    });
}

QSize LightPanel::sizeHint() const { return findChild<QScrollArea*>()->widget()->sizeHint() + QSize(24, 4); }

void LightPanel::follow() {
    setEnabled(isReady(m_services));
    if (!m_services.store().hasVolume()) return;
    const QSignalBlocker right(m_right), up(m_up);
    const Light& light = m_services.scene().session.display->light;
    m_on->setChecked(light.on);
    const LightPreset* preset = presetOf(light);
    m_preset->setCurrentIndex(preset == nullptr ? -1 : static_cast<int>(preset - lightPresets().data()));
    const Vec3 toward = glm::normalize(light.direction);
    if (std::abs(toward.y) <= 1 - 1e-9) showNumber(*m_right, kDegrees * std::atan2(toward.x, toward.z));
    showNumber(*m_up, kDegrees * std::asin(std::clamp(toward.y, -1.0, 1.0)));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_right, m_up}) widget->setEnabled(light.on);
    m_fromEye->setEnabled(light.on && light.direction != Light{}.direction);
}

PanelInfo lightPanel() {
    return {.id = "light",
            .title = QObject::tr("Light"),
            .area = Qt::RightDockWidgetArea,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+L"),
            .tip = QObject::tr("Light and its presets, silhouettes, occlusion, depth cue"),
            .make = [](Services& services, Controllers&, QWidget* parent) {
                SessionStore& store = services.store();
                QAction* const light = services.actions().add(
                    QObject::tr("&View"), "shadingAction", QObject::tr("&Light"), "L",
                    QObject::tr("Light by the gradient of the values, or plain colours"),
                    [&store] {
                        store.edit(QObject::tr("Light"), {}, [](Session& session) {
                            session.display.edit([](DisplaySettings& d) { d.light.on = !d.light.on; });
                        });
                    },
                    [&services] { return isReady(services); },
                    {.checked = [&store] { return store.session().display->light.on; }, .separatorBefore = true});
                QObject::connect(&store, &SessionStore::changed, &services.actions(),
                                 [&services](const Scene& before, const Scene& after) {
                                     if (before.session.display->light.on != after.session.display->light.on)
                                         services.actions().refresh();
                                 });
                return new LightPanel(services, *light, parent);
            }};
}

} // namespace pellucid::gui
