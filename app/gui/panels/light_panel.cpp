#include "panels/light_panel.h"

#include <cmath>
#include <numbers>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>

#include <glm/geometric.hpp>

#include "panels/panel.h"
#include "render/light_presets.h"
#include "services/services.h"
#include "widgets/number_box.h"
#include "widgets/scrolled.h"

namespace pellucid::gui {
namespace {

constexpr int kSliderSteps = 200;
constexpr double kDegrees = 180 / std::numbers::pi;

bool isReady(Services& services) { return services.isEditable(); }

} // namespace

int LightPanel::Row::positionOf(double number) const {
    const double part = logarithmic ? std::log(number / lo) / std::log(hi / lo) : (number - lo) / (hi - lo);
    return static_cast<int>(std::lround(part * kSliderSteps));
}

double LightPanel::Row::numberAt(int position) const {
    const double part = static_cast<double>(position) / kSliderSteps;
    return logarithmic ? std::round(lo * std::pow(hi / lo, part)) : lo + part * (hi - lo);
}

LightPanel::LightPanel(Services& services, QAction& light, QWidget* parent)
    : QWidget(parent), m_services(services), m_on(new QCheckBox(tr("&Light"), this)), m_preset(new QComboBox(this)),
      m_right(new QDoubleSpinBox(this)), m_up(new QDoubleSpinBox(this)),
      m_fromEye(new QPushButton(tr("From the &eye"), this)) {
    setObjectName("lightPanel");
    m_on->setObjectName("shadingCheck");
    m_on->setToolTip(tr("Light by the gradient of the values; figures do not depend on it (L)"));
    m_preset->setObjectName("lightPresetCombo");
    m_preset->setToolTip(tr("Ready-made light; where it comes from stays"));
    for (const LightPreset& preset : lightPresets()) {
        m_preset->addItem(QString::fromLatin1(preset.name));
        m_preset->setItemData(m_preset->count() - 1, QString::fromLatin1(preset.description), Qt::ToolTipRole);
    }
    m_preset->setPlaceholderText(tr("own"));
    m_fromEye->setObjectName("lightFromEyeButton");
    m_fromEye->setToolTip(tr("The light goes with the viewer; drag in the picture with Ctrl held to turn it"));

    auto* content = new QWidget;
    auto* form = new QFormLayout(content);
    form->setContentsMargins(10, 8, 10, 8);
    form->setVerticalSpacing(6);
    auto* head = new QHBoxLayout;
    head->addWidget(m_on);
    head->addWidget(m_preset, 1);
    form->addRow(head);
    addRow(*form, "lightAmbient", tr("Ambient"), tr("Light from everywhere, of the colour's own brightness, 0 to 2"),
           &Light::ambient, 0, 2);
    addRow(*form, "lightDiffuse", tr("Diffuse"), tr("Light on what faces it, of the colour's own brightness, 0 to 2"),
           &Light::diffuse, 0, 2);
    addRow(*form, "lightSpecular", tr("Specular"), tr("Brightness of highlights, 0 to 2"), &Light::specular, 0, 2);
    addRow(*form, "lightShininess", tr("Shininess"), tr("Exponent of highlights: how small they are, 1 to 1000"),
           &Light::shininess, 1, 1000, true);
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
    form->addRow(tr("From"), from);
    form->addRow(QString(), m_fromEye);
    addRow(*form, "lightSilhouettes", tr("Silhouettes"), tr("How dark surfaces get that are seen edge-on, 0 to 1"),
           &Light::silhouettes, 0, 1);
    addRow(*form, "lightOcclusion", tr("Occlusion"), tr("How dark hollows get, 0 to 1"), &Light::occlusion, 0, 1);
    addRow(*form, "lightDepthCue", tr("Depth cue"), tr("How far the farthest fades into the background, 0 to 1"),
           &Light::depthCue, 0, 1);
    addRow(*form, "lightGradientOpacity", tr("Surfaces"),
           tr("How far what is homogeneous fades, so that surfaces stay, 0 to 1; figures do not depend on it"),
           &Light::gradientOpacity, 0, 1);
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

void LightPanel::addRow(QFormLayout& form, const char* name, const QString& label, const QString& tip,
                        double Light::*value, double lo, double hi, bool logarithmic) {
    Row row{value, lo, hi, logarithmic, new QSlider(Qt::Horizontal, this), new QDoubleSpinBox(this), label};
    row.slider->setObjectName(QString::fromLatin1(name) + "Slider");
    row.slider->setRange(0, kSliderSteps);
    row.slider->setPageStep(kSliderSteps / 10);
    row.slider->setMinimumWidth(70);
    row.slider->setToolTip(tip);
    row.box->setObjectName(name);
    row.box->setRange(lo, hi);
    row.box->setDecimals(logarithmic ? 0 : 2);
    row.box->setSingleStep(logarithmic ? 1 : 0.05);
    row.box->setKeyboardTracking(false);
    row.box->setToolTip(tip);
    auto* both = new QHBoxLayout;
    both->addWidget(row.slider, 1);
    both->addWidget(row.box);
    form.addRow(label, both);
    const std::size_t index = m_rows.size();
    m_rows.push_back(row);
    connect(row.box, &QDoubleSpinBox::valueChanged, this, [this, index](double number) {
        if (!m_showing) edit(m_rows[index], number);
    });
    connect(row.slider, &QSlider::valueChanged, this, [this, index](int position) {
        if (!m_showing) edit(m_rows[index], m_rows[index].numberAt(position));
    });
    connect(row.slider, &QSlider::sliderReleased, this, [this] { m_services.store().commit(); });
}

void LightPanel::edit(const Row& row, double number) {
    const auto change = [&, value = row.value](Session& session) {
        session.display.edit([&](DisplaySettings& d) { d.light.*value = number; });
    };
    if (row.slider->isSliderDown())
        m_services.store().preview(row.name, change);
    else
        m_services.store().edit(row.name, row.box->objectName(), change);
}

void LightPanel::editDirection() {
    if (m_showing) return;
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
    m_showing = true;
    const Light& light = m_services.scene().session.display->light;
    m_on->setChecked(light.on);
    const LightPreset* preset = presetOf(light);
    m_preset->setCurrentIndex(preset == nullptr ? -1 : static_cast<int>(preset - lightPresets().data()));
    for (const Row& row : m_rows) {
        showNumber(*row.box, light.*row.value);
        if (!row.slider->isSliderDown()) row.slider->setValue(row.positionOf(light.*row.value));
    }
    const Vec3 toward = glm::normalize(light.direction);
    const double right = std::abs(toward.y) > 1 - 1e-9 ? m_right->value() : kDegrees * std::atan2(toward.x, toward.z);
    showNumber(*m_right, right);
    showNumber(*m_up, kDegrees * std::asin(std::clamp(toward.y, -1.0, 1.0)));
    // Highlights and shadows need the light; what helps to see depth does not.
    for (QWidget* widget : std::initializer_list<QWidget*>{m_right, m_up}) widget->setEnabled(light.on);
    m_fromEye->setEnabled(light.on && light.direction != Light{}.direction);
    for (const Row& row : m_rows) {
        const bool ofLight = row.value == &Light::ambient || row.value == &Light::diffuse ||
                             row.value == &Light::specular || row.value == &Light::shininess;
        row.slider->setEnabled(!ofLight || light.on);
        row.box->setEnabled(!ofLight || light.on);
    }
    m_showing = false;
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
