// The panel of light: what makes shapes visible. No figure depends on it.
#include <cmath>
#include <numbers>

#include <QCheckBox>
#include <QPushButton>

#include <glm/geometric.hpp>

#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "render/light_presets.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"

namespace pellucid::gui {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

class LightPanel : public QWidget {
public:
    /// `light` puts it on and off.
    LightPanel(Services& services, QAction& light, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }

private:
    void follow();
    void edit(const QString& text, const QString& mergeKey, const std::function<void(Light&)>& change);
    void editDirection();

    Services& m_services;
    QCheckBox* m_on = named(new QCheckBox(tr("&Light"), this), "shadingCheck",
                            tr("Light by the gradient of the values; figures do not depend on it (L)"));
    QComboBox* m_preset =
        named(new QComboBox(this), "lightPresetCombo", tr("Ready-made light; the direction that it comes from stays"));
    QDoubleSpinBox* m_right = named(new QDoubleSpinBox(this), "lightRight",
                                    tr("How far from the right the light comes, degrees; 0 is from the eye"));
    QDoubleSpinBox* m_up = named(new QDoubleSpinBox(this), "lightUp",
                                 tr("How far from above the light comes, degrees; 0 is from the eye"));
    QPushButton* m_fromEye = named(new QPushButton(tr("From the &eye"), this), "lightFromEyeButton",
                                   tr("The light goes with the viewer; drag in the picture with Ctrl held to turn it"));
};

LightPanel::LightPanel(Services& services, QAction& light, QWidget* parent) : QWidget(parent), m_services(services) {
    setObjectName("lightPanel");
    for (const LightPreset& preset : lightPresets())
        addItem(*m_preset, QString::fromLatin1(preset.name), {}, QString::fromLatin1(preset.description));
    m_preset->setPlaceholderText(tr("own"));
    withLook(m_right, {.lo = -180, .hi = 180, .step = 5, .suffix = tr("°")});
    withLook(m_up, {.lo = -90, .hi = 90, .step = 5, .suffix = tr("°")});

    QFormLayout* const form = scrolledForm(this, 6);
    form->addRow(rowOf({m_on, {m_preset, 1}}));
    auto* rows = new SettingRows(m_services, *form, settingPart<Light>(&Session::display, &DisplaySettings::light));
    rows->add("ambient", {.id = "lightAmbient", .slider = true});
    rows->add("diffuse", {.id = "lightDiffuse", .slider = true});
    rows->add("specular", {.id = "lightSpecular", .slider = true});
    rows->add("shininess", {.id = "lightShininess", .slider = true, .logarithmic = true, .decimals = 0, .step = 1});
    form->addRow(tr("From"), rowOf({{m_right, 1}, {m_up, 1}}));
    form->addRow(QString(), m_fromEye);
    rows->add("silhouettes", {.id = "lightSilhouettes", .slider = true});
    rows->add("occlusion", {.id = "lightOcclusion", .slider = true});
    rows->add("depth_cue", {.id = "lightDepthCue", .slider = true});
    rows->add("gradient_opacity", {.id = "lightGradientOpacity", .slider = true});
    rows->follow();

    connect(m_on, &QCheckBox::clicked, &light, &QAction::trigger);
    connect(m_preset, &QComboBox::activated, this, [this](int index) {
        const LightPreset& preset = lightPresets()[static_cast<std::size_t>(index)];
        edit(tr("Light: %1").arg(QString::fromLatin1(preset.name)), {},
             [&](Light& present) { present = withPreset(present, preset); });
    });
    for (QDoubleSpinBox* box : {m_right, m_up})
        connect(box, &QDoubleSpinBox::valueChanged, this, &LightPanel::editDirection);
    connect(m_fromEye, &QPushButton::clicked, this,
            [this] { edit(tr("Light from the eye"), {}, [](Light& l) { l.direction = Light{}.direction; }); });
    followParts(
        m_services, this, [this] { follow(); }, &Session::display);
}

void LightPanel::edit(const QString& text, const QString& mergeKey, const std::function<void(Light&)>& change) {
    editPart(m_services.store(), &Session::display, text, mergeKey, [&](DisplaySettings& d) { change(d.light); });
}

void LightPanel::editDirection() {
    const double right = m_right->value() / kDegrees, up = m_up->value() / kDegrees;
    const Vec3 direction{std::sin(right) * std::cos(up), std::sin(up), std::cos(right) * std::cos(up)};
    edit(tr("Light's direction"), "lightDirection", [&](Light& light) { light.direction = direction; });
}

void LightPanel::follow() {
    setEnabled(m_services.isEditable());
    if (!m_services.store().hasVolume()) return;
    const Light& light = m_services.scene().session.display->light;
    m_on->setChecked(light.on);
    const LightPreset* preset = presetOf(light);
    m_preset->setCurrentIndex(preset == nullptr ? -1 : static_cast<int>(preset - lightPresets().data()));
    const Vec3 toward = glm::normalize(light.direction);
    if (std::abs(toward.y) <= 1 - 1e-9) showNumber(*m_right, kDegrees * std::atan2(toward.x, toward.z));
    showNumber(*m_up, kDegrees * std::asin(std::clamp(toward.y, -1.0, 1.0)));
    for (QWidget* widget : {m_right, m_up}) widget->setEnabled(light.on);
    m_fromEye->setEnabled(light.on && light.direction != Light{}.direction);
}

} // namespace

PanelInfo lightPanel() {
    return {.id = "light",
            .title = QObject::tr("Light"),
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
                        editPart(store, &Session::display, QObject::tr("Light"), {},
                                 [](DisplaySettings& d) { d.light.on = !d.light.on; });
                    },
                    [&services] { return services.isEditable(); },
                    {.checked = [&store] { return store.session().display->light.on; }, .separatorBefore = true});
                return new LightPanel(services, *light, parent);
            }};
}

} // namespace pellucid::gui
