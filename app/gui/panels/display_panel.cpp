#include "panels/display_panel.h"

#include <algorithm>
#include <array>

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QToolButton>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "services/services.h"
#include "widgets/named.h"
#include "widgets/number_box.h"
#include "widgets/number_text.h"
#include "widgets/scrolled.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// In the order of RenderMode.
const std::array kModes{
    std::pair{QT_TR_NOOP("Composite"), QT_TR_NOOP("Emission and absorption by the transfer function")},
    std::pair{QT_TR_NOOP("Maximum (MIP)"), QT_TR_NOOP("The largest value along each ray, as grey")},
    std::pair{QT_TR_NOOP("Minimum (MinIP)"), QT_TR_NOOP("The smallest value, as grey")},
    std::pair{QT_TR_NOOP("Average"), QT_TR_NOOP("The mean value, as grey: like an X-ray")},
    std::pair{QT_TR_NOOP("Surfaces"), QT_TR_NOOP("The first surface of each feature")}};

constexpr double kCoarsestFinest = 0.5,
                 kMostFinest = kFinestStep; ///< offered as the finest step, and powers of 2 between

constexpr Rgb kFirstTop{0.16, 0.19, 0.24}; // of a gradient that is switched on

QString finestText(double step) {
    return step < kCoarsestFinest ? QObject::tr("%1 d0").arg(stepText(step))
                                  : QObject::tr("%1 d0 everywhere").arg(stepText(kCoarsestFinest));
}

QPixmap swatchOf(const Rgb& color) {
    QPixmap swatch(22, 14);
    swatch.fill(colorFromRgb(color));
    return swatch;
}

} // namespace

DisplayPanel::DisplayPanel(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening), m_mode(new QComboBox(this)),
      m_background(new QToolButton(this)), m_gradient(new QCheckBox(tr("to the top"), this)),
      m_top(new QToolButton(this)), m_feature(new QComboBox(this)), m_finest(new QComboBox(this)),
      m_lo(new QDoubleSpinBox(this)), m_hi(new QDoubleSpinBox(this)),
      m_wholeRange(new QPushButton(tr("&All values"), this)), m_component(new QSpinBox(this)),
      m_note(new QLabel(this)) {
    setObjectName("displayPanel");
    named(m_mode, "modeCombo", tr("What becomes of the values along a ray"));
    for (const auto& [text, tip] : kModes) {
        m_mode->addItem(tr(text));
        m_mode->setItemData(m_mode->count() - 1, tr(tip), Qt::ToolTipRole);
    }
    named(m_background, "backgroundColor", tr("Colour behind the volume; a saved picture can be transparent instead"));
    named(m_gradient, "gradientCheck", tr("Another colour at the top of the picture"));
    named(m_top, "backgroundTopColor", tr("Colour at the top of the picture"));
    named(m_feature, "onlyFeatureCombo", tr("Draw the voxels of one feature alone; figures are of all"));
    named(m_finest, "finestStepCombo",
          tr("How finely the picture is drawn when the scene rests: the steps along a ray are halved, down\n"
             "to this, where the picture would change by 1/255 otherwise. Long steps leave rings where\n"
             "opacity rises steeply. d0 is the smallest distance of voxels"));
    for (double step = kCoarsestFinest; step >= kMostFinest; step /= 2) m_finest->addItem(finestText(step), step);
    named(m_wholeRange, "wholeRangeButton", tr("From the smallest to the largest value of the data"));
    m_component->setObjectName("componentSpin");
    m_component->setRange(0, 1'000'000);
    m_component->setKeyboardTracking(false);
    m_component->setToolTip(tr("Which number of each voxel is shown, where the file has several; from 0"));
    for (QDoubleSpinBox* box : {m_lo, m_hi}) {
        box->setKeyboardTracking(false);
        box->setRange(-1e300, 1e300);
        box->setMinimumWidth(QFontMetrics(font()).horizontalAdvance("-00000.000") + 24);
    }
    m_lo->setObjectName("windowLo");
    m_hi->setObjectName("windowHi");
    m_lo->setToolTip(tr("Value of intensity 0, in the units of the data: what is below is drawn as if it were this"));
    m_hi->setToolTip(tr("Value of intensity 1, in the units of the data: what is above is drawn as if it were this"));
    m_note->setWordWrap(true);
    makeFaint(*m_note);

    auto* content = new QWidget;
    auto* form = new QFormLayout(content);
    form->setContentsMargins(10, 8, 10, 8);
    form->setVerticalSpacing(7);
    form->addRow(tr("&Mode"), m_mode);
    auto* behind = new QHBoxLayout;
    behind->addWidget(m_background);
    behind->addWidget(m_gradient);
    behind->addWidget(m_top);
    behind->addStretch(1);
    form->addRow(tr("Background"), behind);
    form->addRow(tr("&Only"), m_feature);
    form->addRow(tr("&Finest step"), m_finest);
    auto* window = new QGridLayout;
    window->addWidget(m_lo, 0, 0);
    window->addWidget(m_hi, 0, 1);
    window->addWidget(m_wholeRange, 1, 0, 1, 2);
    form->addRow(tr("Values"), window);
    form->addRow(tr("Co&mponent"), m_component);
    form->addRow(m_note);
    fillScrolled(this, content);

    SessionStore& store = m_services.store();
    connect(m_mode, &QComboBox::activated, this, [this](int index) {
        m_services.store().edit(tr("Mode"), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) { d.mode = static_cast<RenderMode>(index); });
        });
    });
    connect(m_background, &QToolButton::clicked, this, [this] { chooseBackground(false); });
    connect(m_top, &QToolButton::clicked, this, [this] { chooseBackground(true); });
    connect(m_gradient, &QCheckBox::clicked, this, [this](bool checked) {
        m_services.store().edit(tr("Background"), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) {
                d.backgroundTop.reset();
                if (checked) d.backgroundTop = kFirstTop;
            });
        });
    });
    connect(m_feature, &QComboBox::activated, this, [this] {
        const auto id = static_cast<FeatureId>(m_feature->currentData().toULongLong());
        m_services.store().edit(tr("Feature alone"), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) { d.onlyFeature = id; });
        });
    });
    connect(m_finest, &QComboBox::activated, this, [this] {
        m_services.store().edit(tr("Finest step"), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) { d.finestStep = m_finest->currentData().toDouble(); });
        });
    });
    connect(m_lo, &QDoubleSpinBox::valueChanged, this, &DisplayPanel::editWindow);
    connect(m_hi, &QDoubleSpinBox::valueChanged, this, &DisplayPanel::editWindow);
    connect(m_wholeRange, &QPushButton::clicked, this, [this] {
        m_opening.editData(tr("All values"), [](Session& session) {
            session.variables.edit([](std::vector<Variable>& all) { all.front().window.reset(); });
        });
    });
    connect(m_component, &QSpinBox::valueChanged, this, [this](int component) {
        m_opening.editData(tr("Component"), [component](Session& session) {
            session.variables.edit([&](std::vector<Variable>& all) { all.front().source.component = component; });
        });
    });
    connect(&m_opening, &OpenController::busyChanged, this, [this] {
        if (!m_opening.isBusy()) follow(); // also where it failed; till then it shows what was asked for
    });
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        const Session &old = before.session, &now = after.session;
        const bool same =
            before.volume == after.volume && before.tf.features == after.tf.features && old.display.isSame(now.display);
        if (!same) follow(); // the view turns, the curve is dragged: nothing of this panel's
    });
    connect(&m_services, &Services::readOnlyChanged, this, &DisplayPanel::follow);
    follow();
}

void DisplayPanel::chooseBackground(bool top) {
    const DisplaySettings& display = *m_services.store().session().display;
    const Rgb now = top ? display.backgroundTop.value_or(display.background) : display.background;
    const QColor color = QColorDialog::getColor(
        colorFromRgb(now), this, top ? tr("Colour at the top of the picture") : tr("Colour behind the volume"));
    if (!color.isValid()) return;
    m_services.store().edit(tr("Background"), {}, [&](Session& session) {
        session.display.edit([&](DisplaySettings& d) {
            if (top)
                d.backgroundTop = rgbFromColor(color);
            else
                d.background = rgbFromColor(color);
        });
    });
}

void DisplayPanel::editWindow() {
    const ValueRange window{m_lo->value(), m_hi->value()};
    if (!(window.lo < window.hi)) return follow(); // nothing lies between them
    m_opening.editData(tr("Values"), [window](Session& session) {
        session.variables.edit([&](std::vector<Variable>& all) { all.front().window = window; });
    });
}

void DisplayPanel::follow() {
    const Scene& scene = m_services.scene();
    const bool ready = m_services.isEditable();
    setEnabled(ready);
    if (!m_services.store().hasVolume()) return;
    const QSignalBlocker low(m_lo), high(m_hi), quiet(m_component); // other decimals are other numbers to them
    const DisplaySettings& display = *scene.session.display;
    m_mode->setCurrentIndex(static_cast<int>(display.mode));
    m_background->setIcon(swatchOf(display.background));
    m_gradient->setChecked(display.backgroundTop.has_value());
    m_top->setIcon(swatchOf(display.backgroundTop.value_or(display.background)));
    m_top->setEnabled(display.backgroundTop.has_value());
    m_feature->clear();
    m_feature->addItem(tr("all features"), QVariant::fromValue<qulonglong>(0));
    for (const Feature& f : scene.tf.features) {
        QPixmap color(12, 12);
        color.fill(colorFromRgb(f.color));
        m_feature->addItem(color, QString::fromStdString(f.name), QVariant::fromValue<qulonglong>(f.id));
    }
    m_feature->setCurrentIndex(scene.onlyFeature() + 1);
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
    m_note->setText(tr("The data has values from %1 to %2.")
                        .arg(numberText(all.lo, all.hi - all.lo), numberText(all.hi, all.hi - all.lo)));
    const VolumeSource& source = scene.session.variable().source;
    if (m_component->value() != source.component) m_component->setValue(source.component);
    m_component->setEnabled(ready && !source.isSample() && !source.raw);
}

PanelInfo displayPanel() {
    return {.id = "display",
            .title = QObject::tr("Display"),
            .area = Qt::RightDockWidgetArea,
            .visible = false,
            .size = 0,
            .keys = QKeySequence("Ctrl+D"),
            .tip =
                QObject::tr("Mode, background, one feature alone, how finely it is drawn, range of values, component"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new DisplayPanel(services, controllers.opening, parent);
            }};
}

} // namespace pellucid::gui
