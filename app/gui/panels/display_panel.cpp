#include "panels/display_panel.h"

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QSpinBox>
#include <QToolButton>
#include <QVBoxLayout>

#include "controllers/open_controller.h"
#include "number_box.h"
#include "number_text.h"
#include "panel.h"
#include "theme.h"
#include "workbench.h"

namespace pellucid::gui {
namespace {

constexpr double kThinnest = 0.1; // per cent of the box that clipping leaves at least
constexpr const char* kAxes[] = {"x", "y", "z"};

} // namespace

DisplayPanel::DisplayPanel(Workbench& bench, QWidget* parent)
    : QWidget(parent), m_bench(bench), m_shading(new QCheckBox(tr("&Shading"), this)),
      m_background(new QToolButton(this)), m_feature(new QComboBox(this)),
      m_resetClip(new QPushButton(tr("&Whole box"), this)), m_lo(new QDoubleSpinBox(this)),
      m_hi(new QDoubleSpinBox(this)), m_wholeRange(new QPushButton(tr("&All values"), this)),
      m_component(new QSpinBox(this)), m_note(new QLabel(this)) {
    setObjectName("displayPanel");
    m_shading->setObjectName("shadingCheck");
    m_shading->setToolTip(tr("Light from the eye, by the gradient; figures do not depend on it (L)"));
    m_background->setObjectName("backgroundColor");
    m_background->setToolTip(tr("Colour behind the volume"));
    m_feature->setObjectName("onlyFeatureCombo");
    m_feature->setToolTip(tr("Draw the voxels of one feature alone; figures are of all"));
    m_resetClip->setObjectName("resetClipButton");
    m_resetClip->setToolTip(tr("Cut nothing away"));
    m_wholeRange->setObjectName("wholeRangeButton");
    m_wholeRange->setToolTip(tr("From the smallest to the largest value of the data"));
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
    m_note->setStyleSheet(QStringLiteral("color: %1").arg(theme::kFaint.name()));

    auto* content = new QWidget;
    auto* form = new QFormLayout(content);
    form->setContentsMargins(10, 8, 10, 8);
    form->setVerticalSpacing(7);
    auto* look = new QHBoxLayout;
    look->addWidget(m_shading);
    look->addStretch(1);
    look->addWidget(new QLabel(tr("Background"), content));
    look->addWidget(m_background);
    form->addRow(tr("Picture"), look);
    form->addRow(tr("&Only"), m_feature);
    auto* clip = new QGridLayout;
    clip->setHorizontalSpacing(6);
    for (int axis = 0; axis < 3; ++axis) {
        clip->addWidget(new QLabel(kAxes[axis], content), axis, 0);
        for (int side = 0; side < 2; ++side) {
            auto* box = new QDoubleSpinBox(content);
            box->setObjectName(QStringLiteral("clip%1%2").arg(QString(kAxes[axis]).toUpper(), side == 0 ? "Lo" : "Hi"));
            box->setRange(0, 100);
            box->setDecimals(1);
            box->setSuffix(tr(" %"));
            box->setKeyboardTracking(false);
            box->setToolTip(tr("The part of the box along %1 that is drawn, per cent of its length; figures are of all")
                                .arg(kAxes[axis]));
            clip->addWidget(box, axis, side + 1);
            m_clip[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] = box;
            connect(box, &QDoubleSpinBox::valueChanged, this,
                    [this, axis, side](double percent) { editClipping(axis, side == 1, percent); });
        }
    }
    clip->addWidget(m_resetClip, 3, 1, 1, 2);
    form->addRow(tr("Clip"), clip);
    auto* window = new QGridLayout;
    window->addWidget(m_lo, 0, 0);
    window->addWidget(m_hi, 0, 1);
    window->addWidget(m_wholeRange, 1, 0, 1, 2);
    form->addRow(tr("Values"), window);
    form->addRow(tr("Co&mponent"), m_component);
    form->addRow(m_note);
    auto* scroll = new QScrollArea(this);
    scroll->setWidget(content);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(scroll);

    SessionStore& store = m_bench.store();
    connect(m_shading, &QCheckBox::clicked, this, [this] { m_bench.actions().find("shadingAction")->trigger(); });
    connect(m_background, &QToolButton::clicked, this, [this] {
        const QColor color = QColorDialog::getColor(colorFromRgb(m_bench.store().session().display->background), this,
                                                    tr("Colour behind the volume"));
        if (!color.isValid()) return;
        m_bench.store().edit(tr("Background"), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) { d.background = rgbFromColor(color); });
        });
    });
    connect(m_feature, &QComboBox::activated, this, [this] {
        const auto id = static_cast<FeatureId>(m_feature->currentData().toULongLong());
        m_bench.store().edit(tr("Feature alone"), {}, [&](Session& session) {
            session.display.edit([&](DisplaySettings& d) { d.onlyFeature = id; });
        });
    });
    connect(m_resetClip, &QPushButton::clicked, this,
            [this] { m_bench.store().edit(tr("Whole box"), {}, [](Session& session) { session.clipping.set({}); }); });
    connect(m_lo, &QDoubleSpinBox::valueChanged, this, &DisplayPanel::editWindow);
    connect(m_hi, &QDoubleSpinBox::valueChanged, this, &DisplayPanel::editWindow);
    connect(m_wholeRange, &QPushButton::clicked, this, [this] {
        m_bench.opening().editData(tr("All values"), [](Session& session) {
            session.variables.edit([](std::vector<Variable>& all) { all.front().window.reset(); });
        });
    });
    connect(m_component, &QSpinBox::valueChanged, this, [this](int component) {
        if (m_showing) return;
        m_bench.opening().editData(tr("Component"), [component](Session& session) {
            session.variables.edit([&](std::vector<Variable>& all) { all.front().source.component = component; });
        });
    });
    connect(&m_bench.opening(), &OpenController::busyChanged, this, [this] {
        if (!m_bench.opening().isBusy()) follow(); // also where it failed; till then it shows what was asked for
    });
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        const Session &old = before.session, &now = after.session;
        const bool same = before.volume == after.volume && before.tf.features == after.tf.features &&
                          old.display.isSame(now.display) && old.clipping.isSame(now.clipping);
        if (!same) follow(); // the view turns, the curve is dragged: nothing of this panel's
    });
    connect(&m_bench, &Workbench::readOnlyChanged, this, &DisplayPanel::follow);
    follow();
}

void DisplayPanel::editClipping(int axis, bool upper, double percent) {
    if (m_showing) return;
    m_bench.store().edit(tr("Clip"), QStringLiteral("clip-%1-%2").arg(axis).arg(upper), [&](Session& session) {
        session.clipping.edit([&](Clipping& c) {
            if (upper)
                c.hi[axis] = std::max(percent / 100, c.lo[axis] + kThinnest / 100);
            else
                c.lo[axis] = std::min(percent / 100, c.hi[axis] - kThinnest / 100);
        });
    });
}

void DisplayPanel::editWindow() {
    if (m_showing) return;
    const ValueRange window{m_lo->value(), m_hi->value()};
    if (!(window.lo < window.hi)) return follow(); // nothing lies between them
    m_bench.opening().editData(tr("Values"), [window](Session& session) {
        session.variables.edit([&](std::vector<Variable>& all) { all.front().window = window; });
    });
}

void DisplayPanel::follow() {
    const Scene& scene = m_bench.scene();
    const bool ready = m_bench.store().hasVolume() && !m_bench.isReadOnly();
    setEnabled(ready);
    if (!m_bench.store().hasVolume()) return;
    m_showing = true;
    m_shading->setChecked(scene.session.display->light.on);
    QPixmap swatch(22, 14);
    swatch.fill(colorFromRgb(scene.session.display->background));
    m_background->setIcon(swatch);
    m_feature->clear();
    m_feature->addItem(tr("all features"), QVariant::fromValue<qulonglong>(0));
    for (const Feature& f : scene.tf.features) {
        QPixmap color(12, 12);
        color.fill(colorFromRgb(f.color));
        m_feature->addItem(color, QString::fromStdString(f.name), QVariant::fromValue<qulonglong>(f.id));
    }
    m_feature->setCurrentIndex(scene.onlyFeature() + 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        showNumber(*m_clip[axis][0], 100 * scene.session.clipping->lo[a]);
        showNumber(*m_clip[axis][1], 100 * scene.session.clipping->hi[a]);
    }
    m_resetClip->setEnabled(!(*scene.session.clipping == Clipping{}));
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
    m_showing = false;
}

PanelInfo displayPanel() {
    return {.id = "display",
            .title = QObject::tr("Display"),
            .area = Qt::RightDockWidgetArea,
            .visible = false,
            .size = 0,
            .keys = QKeySequence("Ctrl+D"),
            .tip = QObject::tr("Light, clipping, one feature alone, range of values, component"),
            .make = [](Workbench& bench, QWidget* parent) {
                SessionStore& store = bench.store();
                bench.actions().add({.id = "shadingAction",
                                     .menu = QObject::tr("&View"),
                                     .text = QObject::tr("&Shading"),
                                     .keys = {QKeySequence("L")},
                                     .tip = QObject::tr("Light from the eye, by the gradient"),
                                     .trigger =
                                         [&store] {
                                             store.edit(QObject::tr("Shading"), {}, [](Session& session) {
                                                 session.display.edit(
                                                     [](DisplaySettings& d) { d.light.on = !d.light.on; });
                                             });
                                         },
                                     .enabled = [&bench] { return bench.store().hasVolume() && !bench.isReadOnly(); },
                                     .checked = [&store] { return store.session().display->light.on; },
                                     .separatorBefore = true});
                QObject::connect(&store, &SessionStore::changed, &bench.actions(),
                                 [&bench](const Scene& before, const Scene& after) {
                                     if (!before.session.display.isSame(after.session.display))
                                         bench.actions().refresh();
                                 });
                return new DisplayPanel(bench, parent);
            }};
}

} // namespace pellucid::gui
