// The panel of fields: which one is drawn in the place of the data, how, and where it is saved.
#include <array>
#include <cmath>

#include <QLineEdit>
#include <QLocale>
#include <QPushButton>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "tf/color_maps.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// By FieldKind.
const std::array kTips{
    QT_TR_NOOP("How much of each voxel reaches the eye, 0 to 1"),
    QT_TR_NOOP("How much the brightness of each voxel differs from its surroundings, 0 to 1"),
    QT_TR_NOOP("How much the saturation of each voxel differs from its surroundings, 0 to 1.34"),
    QT_TR_NOOP("Both saliencies, each with its weight u1 or u2"),
    QT_TR_NOOP("Each voxel's share of the visibility-weighted saliency: those of a feature sum to its VWS")};

class FieldsPanel : public QWidget {
public:
    FieldsPanel(Services& services, FieldController& fields, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }

private:
    void fillLists();
    void addRows(QFormLayout& form);
    void edit(const QString& text, const std::function<void(FieldView&)>& change);
    void editTop();
    void follow();      ///< the session
    void followField(); ///< what has become of the field
    QString stateText() const;

    Services& m_services;
    FieldController& m_fields;
    QComboBox* m_kind = named(new QComboBox(this), "fieldKindCombo",
                              tr("What is drawn: the data, or what each voxel contributes to this picture (V)"));
    QComboBox* m_feature = named(
        new QComboBox(this), "fieldFeatureCombo",
        tr("The field in the voxels of one feature alone; its colours stay those of the whole field, so that features "
           "can be compared"));
    QComboBox* m_colorMap =
        named(new QComboBox(this), "fieldColorMapCombo", tr("Colours from 0 to the top of the field"));
    QLineEdit* m_top = named(new QLineEdit(this), "fieldTop",
                             tr("Value of the field that the colours reach to, above 0; in the unit of the field"));
    QPushButton* m_usualTop =
        named(new QPushButton(tr("&Default"), this), "fieldUsualTop",
              tr("The value below which lie 99.9 % of the field's values above 0, in the voxels of all features"));
    QPushButton* m_stop = named(new QPushButton(this), "fieldStop");
    QPushButton* m_save = named(new QPushButton(tr("Sa&ve…"), this), "fieldSave",
                                tr("Write the values of this field to an NRRD file, on the grid of the data"));
    QLabel* m_state = wrappedLabel("fieldState", this);
    QProgressBar* m_progress = progressBar("fieldProgress", this);
};

FieldsPanel::FieldsPanel(Services& services, FieldController& fields, QWidget* parent)
    : QWidget(parent), m_services(services), m_fields(fields) {
    setObjectName("fieldsPanel");
    fillLists();
    makeFaint(*m_state);
    m_progress->setMaximumHeight(6);
    addRows(*scrolledForm(this, 7));

    connect(m_kind, &QComboBox::activated, this, [this](int index) {
        const int kind = m_kind->itemData(index).toInt();
        m_fields.show(kind < 0 ? std::nullopt : std::optional(static_cast<FieldKind>(kind)));
    });
    connect(m_feature, &QComboBox::activated, this, [this] {
        edit(tr("Field of a feature"), [id = chosenFeature(*m_feature)](FieldView& f) { f.feature = id; });
    });
    connect(m_colorMap, &QComboBox::activated, this, [this] {
        edit(tr("Colours of the field"),
             [name = m_colorMap->currentData().toString().toStdString()](FieldView& f) { f.colorMap = name; });
    });
    connect(m_top, &QLineEdit::editingFinished, this, &FieldsPanel::editTop);
    connect(m_usualTop, &QPushButton::clicked, this,
            [this] { edit(tr("Default top of the field"), [](FieldView& f) { f.top.reset(); }); });
    connect(m_stop, &QPushButton::clicked, this,
            [this] { m_fields.state() == FieldController::State::Computing ? m_fields.cancel() : m_fields.compute(); });
    connect(m_save, &QPushButton::clicked, this, [this] { m_fields.chooseFile(); });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.tf.features != after.tf.features) follow();
    });
    connect(&m_fields, &FieldController::changed, this, &FieldsPanel::followField);
    followParts(
        m_services, this, [this] { follow(); }, &Session::field);
}

void FieldsPanel::fillLists() {
    m_kind->addItem(tr("none: the data"), -1);
    for (const FieldKind kind : allOf<FieldKind>()) {
        const auto i = static_cast<std::size_t>(kind);
        addItem(*m_kind, QString::fromLatin1(title(kind)), static_cast<int>(i), tr(kTips[i]));
    }
    addColorMaps(*m_colorMap);
    addItem(*m_colorMap, tr("of the feature"), QString::fromLatin1(kFeatureColorMap),
            tr("Black over the colour of the chosen feature to white; of all features, the default map"));
}

void FieldsPanel::addRows(QFormLayout& form) {
    form.addRow(tr("&Field"), m_kind);
    form.addRow(tr("F&eature"), m_feature);
    form.addRow(tr("&Colours"), m_colorMap);
    auto* rows = new SettingRows(m_services, form, settingPart<FieldView>(&Session::field));
    rows->add("strength", {.id = "fieldStrength",
                           .slider = true,
                           .logarithmic = true,
                           .decimals = 3,
                           .step = 0.01,
                           .least = 0.001,
                           .stepText = tr("Strength of the field")});
    rows->add("threshold", {.id = "fieldThreshold",
                            .slider = true,
                            .decimals = 1,
                            .step = 1,
                            .factor = 100,
                            .suffix = tr(" %"),
                            .most = 99,
                            .stepText = tr("Threshold of the field")});
    rows->follow();
    form.addRow(tr("Top"), rowOf({{m_top, 1}, m_usualTop}));
    form.addRow(m_state);
    form.addRow(m_progress);
    form.addRow(rowOf({{m_stop, 1}, {m_save, 1}}));
}

void FieldsPanel::edit(const QString& text, const std::function<void(FieldView&)>& change) {
    editPart(m_services.store(), &Session::field, text, {}, change);
}

void FieldsPanel::editTop() {
    if (!m_top->isModified()) return;
    bool isNumber = false;
    const double value = QLocale::c().toDouble(m_top->text().trimmed(), &isNumber);
    if (!isNumber || !(value > 0) || !std::isfinite(value)) return followField(); // no such top
    edit(tr("Top of the field"), [value](FieldView& f) { f.top = value; });
}

void FieldsPanel::follow() {
    const Scene& scene = m_services.scene();
    setEnabled(m_services.isEditable());
    const FieldView& view = *scene.session.field;
    const bool on = view.kind.has_value();
    m_kind->setCurrentIndex(on ? 1 + static_cast<int>(*view.kind) : 0);
    fillFeatures(*m_feature, scene, tr("all"), scene.fieldFeature());
    m_colorMap->setCurrentIndex(m_colorMap->findData(QString::fromStdString(view.colorMap)));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_feature, m_colorMap, m_top}) widget->setEnabled(on);
    m_usualTop->setEnabled(on && view.top);
    followField();
}

QString FieldsPanel::stateText() const {
    using State = FieldController::State;
    const Field* const field = m_fields.field();
    switch (m_fields.state()) {
    case State::Off:
        return tr("A field shows what each voxel contributes to the picture, in the same view.");
    case State::Computing:
        return field ? tr("The field that is drawn is of an earlier state; that of the present one is being computed.")
                     : tr("The field is being computed.");
    case State::Current:
        return tr("Largest value %1").arg(QString::number(field->volume->dataRange().hi, 'g', 4));
    case State::Stopped:
        return field ? tr("Stopped; the field that is drawn is of an earlier state.") : tr("Stopped.");
    case State::Failed:
        return QString::fromUtf8(m_fields.failure()->what());
    }
    return {};
}

void FieldsPanel::followField() {
    using State = FieldController::State;
    const State state = m_fields.state();
    const bool computing = state == State::Computing;
    m_stop->setText(computing ? tr("&Stop") : tr("&Compute"));
    m_stop->setToolTip(computing ? tr("Stop computing; the picture stays as it is")
                                 : tr("Compute the field of the present state"));
    m_stop->setEnabled(computing || state == State::Stopped || state == State::Failed);
    m_save->setEnabled(state == State::Current);
    m_progress->setVisible(computing);
    m_progress->setValue(static_cast<int>(100 * m_fields.progress()));
    m_state->setText(stateText());
    if (m_top->hasFocus() && m_top->isModified()) return; // somebody types
    const Field* const field = m_fields.field();
    m_top->setText(field ? QString::number(topOf(*m_services.scene().session.field, *field), 'g', 4) : QString());
    m_top->setModified(false);
}

} // namespace

PanelInfo fieldsPanel() {
    return {.id = "fields",
            .title = QObject::tr("Fields"),
            .group = PanelGroup::Shares,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Shift+V"),
            .tip = QObject::tr("Visibility, saliency and attention (VWS) of each voxel in the place of the data"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new FieldsPanel(services, controllers.fields, parent);
            }};
}

} // namespace pellucid::gui
