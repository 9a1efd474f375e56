#include "panels/fields_panel.h"

#include <array>
#include <cmath>
#include <tuple>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPainter>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "services/services.h"
#include "tf/color_maps.h"
#include "widgets/number_box.h"
#include "widgets/scrolled.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kSteps = 200; ///< of sliders
constexpr double kLeastStrength = 0.001;
constexpr double kMostThreshold = 99; ///< per cent

/// In the order of kFieldKinds.
const std::array kTips{
    QT_TR_NOOP("How much of each voxel reaches the eye, 0 to 1"),
    QT_TR_NOOP("How much the brightness of each voxel differs from its surroundings, 0 to 1"),
    QT_TR_NOOP("How much the saturation of each voxel differs from its surroundings, 0 to 1.34"),
    QT_TR_NOOP("Both saliencies, each with its weight u1 or u2"),
    QT_TR_NOOP("Each voxel's share of the visibility-weighted saliency: those of a feature sum to its VWS")};

QIcon iconOf(const ColorMap& map) {
    QPixmap pixmap(48, 12);
    QPainter painter(&pixmap);
    for (int x = 0; x < pixmap.width(); ++x)
        painter.fillRect(x, 0, 1, pixmap.height(), colorFromRgb(map.colorAt((x + 0.5) / pixmap.width())));
    return pixmap;
}

/// Strengths lie on a logarithmic slider.
int positionOfStrength(double strength) {
    return static_cast<int>(
        std::lround(kSteps * (1 - std::log(std::max(strength, kLeastStrength)) / std::log(kLeastStrength))));
}
double strengthAt(int position) { return std::pow(kLeastStrength, 1 - static_cast<double>(position) / kSteps); }

} // namespace

FieldsPanel::FieldsPanel(Services& services, FieldController& fields, QWidget* parent)
    : QWidget(parent), m_services(services), m_fields(fields), m_kind(new QComboBox(this)),
      m_feature(new QComboBox(this)), m_colorMap(new QComboBox(this)),
      m_strengthSlider(new QSlider(Qt::Horizontal, this)), m_thresholdSlider(new QSlider(Qt::Horizontal, this)),
      m_strength(new QDoubleSpinBox(this)), m_threshold(new QDoubleSpinBox(this)), m_top(new QLineEdit(this)),
      m_usualTop(new QPushButton(tr("&Usual"), this)), m_stop(new QPushButton(this)),
      m_save(new QPushButton(tr("Sa&ve…"), this)), m_state(new QLabel(this)), m_progress(new QProgressBar(this)) {
    setObjectName("fieldsPanel");
    m_kind->setObjectName("fieldKindCombo");
    m_kind->setToolTip(tr("What is drawn: the data, or what each voxel contributes to this picture (V)"));
    m_kind->addItem(tr("none: the data"), -1);
    for (std::size_t i = 0; i < kFieldKinds.size(); ++i) {
        m_kind->addItem(QString::fromLatin1(kFieldKinds[i].title), static_cast<int>(i));
        m_kind->setItemData(m_kind->count() - 1, tr(kTips[i]), Qt::ToolTipRole);
    }
    m_feature->setObjectName("fieldFeatureCombo");
    m_feature->setToolTip(
        tr("The field in the voxels of one feature alone; its colours stay those of the whole field, so "
           "that features compare"));
    m_colorMap->setObjectName("fieldColorMapCombo");
    m_colorMap->setToolTip(tr("Colours from 0 to the top of the field"));
    m_colorMap->setIconSize({48, 12});
    for (const ColorMap& map : colorMaps())
        if (map.kind != ColorMap::Kind::Categorical) {
            m_colorMap->addItem(iconOf(map), QString::fromStdString(map.name), QString::fromStdString(map.name));
            m_colorMap->setItemData(m_colorMap->count() - 1, QString::fromStdString(map.title), Qt::ToolTipRole);
        }
    m_colorMap->addItem(tr("of the feature"), QString::fromLatin1(kFeatureColorMap));
    m_colorMap->setItemData(m_colorMap->count() - 1,
                            tr("Black over the colour of the chosen feature to white; of all features, the usual map"),
                            Qt::ToolTipRole);
    const QString strengthTip = tr(
        "Opacity of a path of one reference length, the smallest voxel spacing, at the top of the field, 0.001 to 1");
    m_strengthSlider->setObjectName("fieldStrengthSlider");
    m_strength->setObjectName("fieldStrength");
    m_strength->setRange(kLeastStrength, 1);
    m_strength->setDecimals(3);
    m_strength->setSingleStep(0.01);
    const QString thresholdTip = tr("Values up to here are not drawn, per cent of the top");
    m_thresholdSlider->setObjectName("fieldThresholdSlider");
    m_threshold->setObjectName("fieldThreshold");
    m_threshold->setRange(0, kMostThreshold);
    m_threshold->setDecimals(1);
    m_threshold->setSuffix(tr(" %"));
    for (const auto& [slider, box, tip] : {std::tuple(m_strengthSlider, m_strength, strengthTip),
                                           std::tuple(m_thresholdSlider, m_threshold, thresholdTip)}) {
        slider->setRange(0, kSteps);
        slider->setPageStep(kSteps / 10);
        slider->setMinimumWidth(70);
        slider->setToolTip(tip);
        box->setKeyboardTracking(false);
        box->setToolTip(tip);
        connect(slider, &QSlider::sliderReleased, this, [this] { m_services.store().commit(); });
    }
    m_top->setObjectName("fieldTop");
    m_top->setToolTip(tr("Value of the field that the colours reach to, above 0; in the unit of the field"));
    m_usualTop->setObjectName("fieldUsualTop");
    m_usualTop->setToolTip(tr("The value below which lie 99.9 % of those above 0, of all features"));
    m_stop->setObjectName("fieldStop");
    m_save->setObjectName("fieldSave");
    m_save->setToolTip(tr("Write the values of this field to an NRRD file, on the grid of the data"));
    m_state->setObjectName("fieldState");
    m_state->setWordWrap(true);
    makeFaint(*m_state);
    m_progress->setObjectName("fieldProgress");
    m_progress->setRange(0, 100);
    m_progress->setTextVisible(false);
    m_progress->setMaximumHeight(6);

    auto* content = new QWidget;
    auto* form = new QFormLayout(content);
    form->setContentsMargins(10, 8, 10, 8);
    form->setVerticalSpacing(7);
    form->addRow(tr("&Field"), m_kind);
    form->addRow(tr("F&eature"), m_feature);
    form->addRow(tr("&Colours"), m_colorMap);
    const auto addPair = [&](const QString& label, QWidget* wide, QWidget* narrow) {
        auto* row = new QHBoxLayout;
        row->addWidget(wide, 1);
        row->addWidget(narrow);
        form->addRow(label, row);
    };
    addPair(tr("Strength"), m_strengthSlider, m_strength);
    addPair(tr("Threshold"), m_thresholdSlider, m_threshold);
    addPair(tr("Top"), m_top, m_usualTop);
    form->addRow(m_state);
    form->addRow(m_progress);
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(m_stop, 1);
    buttons->addWidget(m_save, 1);
    form->addRow(buttons);
    fillScrolled(this, content);

    connect(m_kind, &QComboBox::activated, this, [this](int index) {
        const int kind = m_kind->itemData(index).toInt();
        m_fields.show(kind < 0 ? std::nullopt : std::optional(static_cast<FieldKind>(kind)));
    });
    connect(m_feature, &QComboBox::activated, this, [this] {
        const auto id = static_cast<FeatureId>(m_feature->currentData().toULongLong());
        edit(tr("Field of a feature"), {}, [id](FieldView& f) { f.feature = id; });
    });
    connect(m_colorMap, &QComboBox::activated, this, [this] {
        edit(tr("Colours of the field"), {},
             [name = m_colorMap->currentData().toString().toStdString()](FieldView& f) { f.colorMap = name; });
    });
    connect(m_strength, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        edit(tr("Strength of the field"), "field-strength", [value](FieldView& f) { f.strength = value; });
    });
    connect(m_strengthSlider, &QSlider::valueChanged, this, [this](int position) {
        slide(*m_strengthSlider, tr("Strength of the field"),
              [value = strengthAt(position)](FieldView& f) { f.strength = value; });
    });
    connect(m_threshold, &QDoubleSpinBox::valueChanged, this, [this](double percent) {
        edit(tr("Threshold of the field"), "field-threshold", [percent](FieldView& f) { f.threshold = percent / 100; });
    });
    connect(m_thresholdSlider, &QSlider::valueChanged, this, [this](int position) {
        slide(*m_thresholdSlider, tr("Threshold of the field"),
              [value = kMostThreshold / 100 * position / kSteps](FieldView& f) { f.threshold = value; });
    });
    connect(m_top, &QLineEdit::editingFinished, this, &FieldsPanel::editTop);
    connect(m_usualTop, &QPushButton::clicked, this,
            [this] { edit(tr("Usual top of the field"), {}, [](FieldView& f) { f.top.reset(); }); });
    connect(m_stop, &QPushButton::clicked, this,
            [this] { m_fields.state() == FieldController::State::Computing ? m_fields.cancel() : m_fields.compute(); });
    connect(m_save, &QPushButton::clicked, this, [this] { m_fields.chooseFile(); });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || before.tf.features != after.tf.features ||
            !before.session.field.isSame(after.session.field))
            follow();
    });
    connect(&m_fields, &FieldController::changed, this, &FieldsPanel::followField);
    connect(&m_services, &Services::readOnlyChanged, this, &FieldsPanel::follow);
    follow();
}

QSize FieldsPanel::sizeHint() const { return findChild<QScrollArea*>()->widget()->sizeHint() + QSize(24, 4); }

void FieldsPanel::edit(const QString& text, const QString& mergeKey, const Change& change) {
    if (m_showing) return;
    m_services.store().edit(text, mergeKey, [&](Session& session) { session.field.edit(change); });
}

void FieldsPanel::slide(const QSlider& slider, const QString& text, const Change& change) {
    if (m_showing) return;
    if (slider.isSliderDown())
        m_services.store().preview(text, [&](Session& session) { session.field.edit(change); });
    else
        edit(text, slider.objectName(), change); // by keys
}

void FieldsPanel::editTop() {
    if (m_showing || !m_top->isModified()) return;
    bool isNumber = false;
    const double value = QLocale::c().toDouble(m_top->text().trimmed(), &isNumber);
    if (!isNumber || !(value > 0) || !std::isfinite(value)) return followField(); // no such top
    edit(tr("Top of the field"), {}, [value](FieldView& f) { f.top = value; });
}

void FieldsPanel::follow() {
    const Scene& scene = m_services.scene();
    setEnabled(m_services.isEditable());
    m_showing = true;
    const FieldView& view = *scene.session.field;
    const bool on = view.kind.has_value();
    m_kind->setCurrentIndex(on ? 1 + static_cast<int>(*view.kind) : 0);
    m_feature->clear();
    m_feature->addItem(tr("all"), QVariant::fromValue<qulonglong>(0));
    for (const Feature& f : scene.tf.features) {
        QPixmap color(12, 12);
        color.fill(colorFromRgb(f.color));
        m_feature->addItem(color, QString::fromStdString(f.name), QVariant::fromValue<qulonglong>(f.id));
    }
    m_feature->setCurrentIndex(scene.fieldFeature() + 1);
    m_colorMap->setCurrentIndex(m_colorMap->findData(QString::fromStdString(view.colorMap)));
    if (!m_strengthSlider->isSliderDown()) m_strengthSlider->setValue(positionOfStrength(view.strength));
    if (!m_thresholdSlider->isSliderDown())
        m_thresholdSlider->setValue(static_cast<int>(std::lround(100 * view.threshold / kMostThreshold * kSteps)));
    showNumber(*m_strength, view.strength);
    showNumber(*m_threshold, 100 * view.threshold);
    for (QWidget* widget : std::initializer_list<QWidget*>{m_feature, m_colorMap, m_strengthSlider, m_strength,
                                                           m_thresholdSlider, m_threshold, m_top})
        widget->setEnabled(on);
    m_usualTop->setEnabled(on && view.top);
    m_showing = false;
    followField();
}

void FieldsPanel::followField() {
    using State = FieldController::State;
    const FieldController& fields = m_fields;
    const State state = fields.state();
    const Field* const field = fields.field();
    m_stop->setText(state == State::Computing ? tr("&Stop") : tr("&Compute"));
    m_stop->setToolTip(state == State::Computing ? tr("Stop computing; the picture stays as it is")
                                                 : tr("Compute the field of the present state"));
    m_stop->setEnabled(state == State::Computing || state == State::Stopped || state == State::Failed);
    m_save->setEnabled(state == State::Current);
    m_progress->setVisible(state == State::Computing);
    m_progress->setValue(static_cast<int>(100 * fields.progress()));
    switch (state) {
    case State::Off:
        m_state->setText(tr("A field shows what each voxel contributes to the picture, in the same view."));
        break;
    case State::Computing:
        m_state->setText(field ? tr("What is seen is of an earlier state; the present one is being computed.")
                               : tr("It is being computed."));
        break;
    case State::Current:
        m_state->setText(tr("Largest value %1").arg(QString::number(field->volume->dataRange().hi, 'g', 4)));
        break;
    case State::Stopped:
        m_state->setText(field ? tr("Stopped; what is seen is of an earlier state.") : tr("Stopped."));
        break;
    case State::Failed:
        m_state->setText(QString::fromUtf8(fields.failure()->what()));
        break;
    }
    if (m_top->hasFocus() && m_top->isModified()) return; // somebody types
    m_top->setText(field ? QString::number(topOf(*m_services.scene().session.field, *field), 'g', 4) : QString());
    m_top->setModified(false);
}

PanelInfo fieldsPanel() {
    return {.id = "fields",
            .title = QObject::tr("Fields"),
            .area = Qt::RightDockWidgetArea,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Shift+V"),
            .tip = QObject::tr("Visibility, saliency and VWS of each voxel in the place of the data"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new FieldsPanel(services, controllers.fields, parent);
            }};
}

} // namespace pellucid::gui
