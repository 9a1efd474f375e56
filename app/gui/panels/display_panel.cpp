// The panel of the picture: how it is made, what is behind it, one feature alone, and which values are looked at.
#include <algorithm>
#include <array>
#include <optional>

#include <QPushButton>
#include <QSpinBox>

#include "controllers/controllers.h"
#include "jobs/job.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "session/variable_edits.h"
#include "volume/file_contents.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// In the order of RenderMode.
const std::array kModeTips{QT_TR_NOOP("Emission and absorption by the transfer function"),
                           QT_TR_NOOP("The largest value along each ray, as grey"),
                           QT_TR_NOOP("The smallest value along each ray, as grey"),
                           QT_TR_NOOP("The mean value along each ray, as grey: like an X-ray"),
                           QT_TR_NOOP("The first surface of each feature")};

constexpr double kCoarsestFinest = 0.5,
                 kMostFinest = kFinestStep; ///< offered as the finest step, and powers of 2 between

constexpr int kMostComponents = 1'000'000;

constexpr Rgb kFirstTop{0.16, 0.19, 0.24}; // of a gradient that is switched on

QString finestText(double step) {
    return step < kCoarsestFinest ? QObject::tr("%1 d0").arg(stepText(step))
                                  : QObject::tr("%1 d0 everywhere").arg(stepText(kCoarsestFinest));
}

class DisplayPanel : public QWidget {
public:
    DisplayPanel(Services& services, OpenController& opening, QWidget* parent);

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        follow();
    }

private:
    void addRows(QFormLayout& form);
    void follow();
    void editVariable(const QString& text, const std::function<void(Variable&)>& change);
    void editWindow();
    void followComponent(bool ready);

    Services& m_services;
    OpenController& m_opening;
    QComboBox* m_feature =
        named(new QComboBox(this), "onlyFeatureCombo", tr("Draw only the voxels of one feature; figures are of all"));
    QComboBox* m_finest =
        named(new QComboBox(this), "finestStepCombo",
              tr("How finely the picture is drawn when the scene rests: the steps along a ray are halved, down\n"
                 "to this, where the picture would change by 1/255 otherwise. Long steps leave rings where\n"
                 "opacity rises steeply. d0 is the smallest distance of voxels"));
    QDoubleSpinBox* m_lo = named(new QDoubleSpinBox(this), "windowLo",
                                 tr("Value of intensity 0, in the unit of the data: lower values look the same"));
    QDoubleSpinBox* m_hi = named(new QDoubleSpinBox(this), "windowHi",
                                 tr("Value of intensity 1, in the unit of the data: higher ones are drawn like it"));
    QPushButton* m_wholeRange = named(new QPushButton(tr("&All values"), this), "wholeRangeButton",
                                      tr("From the smallest to the largest value of the data"));
    QSpinBox* m_component =
        named(new QSpinBox(this), "componentSpin",
              tr("Which number of each voxel is shown, where the file has several; the first one is 0"));
    QLabel* m_note = wrappedLabel("displayNote", this);
    std::optional<VolumeSource> m_lookedAt; // by m_components: the first frame
    int m_componentCount = kMostComponents; // as long as it is not known
    Job<VolumeSource, int> m_components;
};

DisplayPanel::DisplayPanel(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening),
      m_components([](const VolumeSource& source, const JobControl& job) { return contentsOf(source, job).components; },
                   [this](const VolumeSource&, int& count) {
                       m_componentCount = count;
                       follow();
                   }) {
    setObjectName("displayPanel");
    for (double step = kCoarsestFinest; step >= kMostFinest; step /= 2) m_finest->addItem(finestText(step), step);
    m_component->setKeyboardTracking(false);
    for (QDoubleSpinBox* box : {m_lo, m_hi}) {
        withLook(box, {-1e300, 1e300});
        box->setMinimumWidth(QFontMetrics(font()).horizontalAdvance("-00000.000") + 24);
    }
    makeFaint(*m_note);
    addRows(*scrolledForm(this, 7));

    connect(m_feature, &QComboBox::activated, this, [this] {
        const FeatureId id = chosenFeature(*m_feature);
        editPart(m_services.store(), &Session::display, tr("Feature alone"), {},
                 [id](DisplaySettings& d) { d.onlyFeature = id; });
    });
    connect(m_finest, &QComboBox::activated, this, [this] {
        const double step = m_finest->currentData().toDouble();
        editPart(m_services.store(), &Session::display, tr("Finest step"), {},
                 [step](DisplaySettings& d) { d.finestStep = step; });
    });
    connect(m_lo, &QDoubleSpinBox::valueChanged, this, &DisplayPanel::editWindow);
    connect(m_hi, &QDoubleSpinBox::valueChanged, this, &DisplayPanel::editWindow);
    connect(m_wholeRange, &QPushButton::clicked, this,
            [this] { editVariable(tr("All values"), [](Variable& v) { v.window.reset(); }); });
    connect(m_component, &QSpinBox::valueChanged, this, [this](int component) {
        m_opening.editData(tr("Component"), [component](Session& session) {
            VolumeSource source = dataVariable(session).source;
            source.component = component;
            setDataSource(session, source);
        });
    });
    connect(&m_opening, &OpenController::busyChanged, this, [this] {
        if (!m_opening.isBusy()) follow(); // also where it failed; till then it shows what was asked for
    });
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.tf.features != after.tf.features) follow();
    });
    followParts(
        m_services, this, [this] { follow(); }, &Session::display);
}

void DisplayPanel::addRows(QFormLayout& form) {
    auto* rows = new SettingRows(m_services, form, settingPart<DisplaySettings>(&Session::display));
    auto* modes = static_cast<QComboBox*>(rows->add("mode", {.id = "modeCombo"}));
    for (int i = 0; i < modes->count(); ++i)
        modes->setItemData(i, tr(kModeTips[static_cast<std::size_t>(i)]), Qt::ToolTipRole);
    rows->add("background", {.id = "backgroundColor"});
    rows->add("background_top", {.id = "gradientCheck",
                                 .colorId = "backgroundTopColor",
                                 .firstColor = kFirstTop,
                                 .stepText = tr("Background")});
    rows->follow();
    form.addRow(tr("&Only"), m_feature);
    form.addRow(tr("&Finest step"), m_finest);
    form.addRow(tr("Values"), columnOf({rowOf({{m_lo, 1}, {m_hi, 1}}), m_wholeRange}));
    form.addRow(tr("Co&mponent"), m_component);
    form.addRow(m_note);
}

void DisplayPanel::editVariable(const QString& text, const std::function<void(Variable&)>& change) {
    m_opening.editData(text,
                       changing(&Session::variables, [change](std::vector<Variable>& all) { change(all.front()); }));
}

void DisplayPanel::editWindow() {
    const ValueRange window{m_lo->value(), m_hi->value()};
    if (!(window.lo < window.hi)) return follow(); // nothing lies between them
    editVariable(tr("Values"), [window](Variable& v) { v.window = window; });
}

void DisplayPanel::follow() {
    const Scene& scene = m_services.scene();
    const bool ready = m_services.isEditable();
    setEnabled(ready);
    if (!m_services.store().hasVolume()) return;
    const QSignalBlocker low(m_lo), high(m_hi), quiet(m_component); // other decimals are other numbers to them
    const DisplaySettings& display = *scene.session.display;
    fillFeatures(*m_feature, scene, tr("all features"), scene.onlyFeature());
    m_finest->setEnabled(display.mode == RenderMode::Composite);
    int finest = m_finest->findData(std::min(display.finestStep, kCoarsestFinest));
    if (finest < 0) { // as the command line wanted it
        finest = m_finest->count();
        m_finest->addItem(finestText(display.finestStep), display.finestStep);
    }
    m_finest->setCurrentIndex(finest);
    const ValueRange window = scene.volume->range();
    const double span = window.hi - window.lo;
    for (QDoubleSpinBox* box : {m_lo, m_hi}) {
        box->setDecimals(decimalsFor(span));
        box->setSingleStep(span > 0 ? span / 100 : 1);
        box->setEnabled(ready && !scene.data->isConstant());
    }
    showNumber(*m_lo, window.lo);
    showNumber(*m_hi, window.hi);
    const ValueRange all = scene.data->range();
    m_wholeRange->setEnabled(window != all);
    m_note->setText(tr("The values of the data run from %1 to %2.")
                        .arg(numberText(all.lo, all.hi - all.lo), numberText(all.hi, all.hi - all.lo)));
    followComponent(ready);
}

/// How many there are the header tells, which takes a moment, or more of a folder: not before it is seen.
void DisplayPanel::followComponent(bool ready) {
    const Scene& scene = m_services.scene();
    const VolumeSource& source = dataVariable(scene.session).source;
    const bool isFile = !source.isSample() && !source.raw;
    VolumeSource first = scene.series->listing().frames.front().source;
    first.component = 0;
    if (m_lookedAt != first) {
        m_components.cancel();
        m_componentCount = kMostComponents;
        m_lookedAt.reset();
    }
    if (isFile && !m_lookedAt && isVisible()) {
        m_lookedAt = first;
        m_components.start(first, QString::fromStdString(first.path));
    }
    m_component->setRange(0, std::max(m_componentCount - 1, source.component));
    m_component->setValue(source.component);
    m_component->setEnabled(ready && isFile && m_componentCount > 1);
}

} // namespace

PanelInfo displayPanel() {
    return {.id = "display",
            .title = QObject::tr("Display"),
            .visible = false,
            .tabOf = "features",
            .keys = QKeySequence("Ctrl+D"),
            .tip =
                QObject::tr("Mode, background, one feature alone, how finely it is drawn, range of values, component"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new DisplayPanel(services, controllers.opening, parent);
            }};
}

} // namespace pellucid::gui
