#include "panels/settings_panel.h"

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "panels/panel.h"
#include "panels/profile_settings.h"
#include "services/services.h"
#include "widgets/number_box.h"
#include "widgets/scrolled.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

QLabel* heading(const QString& text, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    QFont bold = label->font();
    bold.setBold(true);
    label->setFont(bold);
    return label;
}

struct Range {
    double lo, hi, step;
    int decimals;
};

QDoubleSpinBox* numberBox(const char* id, const Range& range, const QString& tip) {
    auto* box = new QDoubleSpinBox;
    box->setObjectName(id);
    box->setDecimals(range.decimals);
    box->setRange(range.lo, range.hi);
    box->setSingleStep(range.step);
    box->setKeyboardTracking(false);
    box->setToolTip(tip);
    return box;
}

} // namespace

PanelInfo settingsPanel() {
    return {
        .id = "settings",
        .title = QObject::tr("Settings"),
        .area = Qt::RightDockWidgetArea,
        .visible = true,
        .tabOf = "features",
        .size = 0,
        .keys = QKeySequence("Ctrl+8"),
        .tip = QObject::tr("How visibility and saliency are measured, and how optimizations search"),
        .make = [](Services& services, Controllers&, QWidget* parent) { return new SettingsPanel(services, parent); }};
}

SettingsPanel::SettingsPanel(Services& services, QWidget* parent) : QWidget(parent), m_services(services) {
    setObjectName("settingsPanel");
    auto* content = new QWidget;
    auto* form = new QFormLayout(content);
    form->setContentsMargins(10, 8, 10, 8);
    form->setVerticalSpacing(5);
    form->setFieldGrowthPolicy(QFormLayout::ExpandingFieldsGrow);
    addOptimization(*form);
    addMeasuring(*form);
    fillScrolled(this, content);
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !before.session.measure.isSame(after.session.measure) ||
            !before.session.optimize.isSame(after.session.optimize))
            follow();
    });
    connect(&services, &Services::readOnlyChanged, this, &SettingsPanel::follow);
    follow();
}

void SettingsPanel::editOptions(const std::function<void(OptimizeOptions&)>& change) {
    if (m_showing) return;
    m_services.store().commit();
    m_services.store().edit(tr("Optimization settings"), "optimize-settings",
                            [&](Session& session) { session.optimize.edit(change); });
    follow(); // also where nothing has come of it
}

void SettingsPanel::editMeasuring(const std::function<void(MeasureSettings&)>& change) {
    if (m_showing) return;
    m_services.store().commit();
    m_services.store().edit(tr("Settings of the figures"), "measure-settings",
                            [&](Session& session) { session.measure.edit(change); });
    follow();
}

void SettingsPanel::addOptimization(QFormLayout& form) {
    const auto options = [this]() -> const OptimizeOptions& { return *m_services.store().session().optimize; };
    const auto isStepped = [options] { return options().method != SearchMethod::Newton; };
    form.addRow(heading(tr("Optimization"), this));

    auto* direction = new QComboBox;
    direction->setObjectName("directionCombo");
    direction->addItem(tr("Toward the targets (method 1)"), static_cast<int>(Direction::Gradient));
    direction->addItem(tr("Backward differences"), static_cast<int>(Direction::Backward));
    direction->addItem(tr("Second order (method 2)"), static_cast<int>(Direction::Second));
    direction->addItem(tr("Exact gradient"), static_cast<int>(Direction::Exact));
    direction->setToolTip(tr("Where steps of the searches go: along 2(W − t)·b; that with ∇W/d from the state before;\n"
                             "∇F/∇F'; or along the exact derivatives. Newton has its own"));
    form.addRow(tr("&Direction"), direction);
    connect(direction, &QComboBox::activated, this, [this, direction] {
        editOptions(
            [&](OptimizeOptions& o) { o.direction = static_cast<Direction>(direction->currentData().toInt()); });
    });
    m_show.push_back([this, direction, options, isStepped] {
        direction->setCurrentIndex(direction->findData(static_cast<int>(options().direction)));
        direction->setEnabled(direction->isEnabled() && isStepped());
    });

    const auto number = [&](const char* id, const QString& label, const Range& range, const QString& tip,
                            double OptimizeOptions::*value, auto isUsed) {
        auto* box = numberBox(id, range, tip);
        form.addRow(label, box);
        connect(box, &QDoubleSpinBox::valueChanged, this,
                [this, value](double to) { editOptions([&](OptimizeOptions& o) { o.*value = to; }); });
        m_show.push_back([box, value, options, isUsed] {
            showNumber(*box, options().*value);
            box->setEnabled(box->isEnabled() && isUsed());
        });
    };
    number("stepSpin", tr("&Step"), {0.0001, 10, 0.01, 4},
           tr("Length of a base step: opacity per unit of the direction; searches try multiples of it"),
           &OptimizeOptions::step, isStepped);
    number("bSpin", tr("&b"), {0.0001, 1e6, 0.1, 4}, tr("Factor of method 1's direction, no unit"), &OptimizeOptions::b,
           [options, isStepped] { return isStepped() && options().direction == Direction::Gradient; });
    number("toleranceSpin", tr("&Tolerance"), {0.0001, 1, 0.01, 4},
           tr("Optimize stops when the distance F of VWS from the targets is below this"), &OptimizeOptions::tolerance,
           [] { return true; });

    auto* limit = new QSpinBox;
    limit->setObjectName("mostMovesSpin");
    limit->setRange(0, 1'000'000);
    limit->setGroupSeparatorShown(true);
    limit->setKeyboardTracking(false);
    limit->setToolTip(tr("Moves at most, of an optimization"));
    form.addRow(tr("&At most"), limit);
    connect(limit, &QSpinBox::valueChanged, this,
            [this](int to) { editOptions([&](OptimizeOptions& o) { o.maxIterations = to; }); });
    m_show.push_back([limit, options] {
        if (limit->value() != options().maxIterations) limit->setValue(options().maxIterations);
    });

    const auto check = [&](const char* id, const QString& label, const QString& tip, bool OptimizeOptions::*value,
                           auto isUsed) {
        auto* box = new QCheckBox(label);
        box->setObjectName(id);
        box->setToolTip(tip);
        form.addRow(QString(), box);
        connect(box, &QCheckBox::clicked, this,
                [this, value](bool to) { editOptions([&](OptimizeOptions& o) { o.*value = to; }); });
        m_show.push_back([box, value, options, isUsed] {
            box->setChecked(options().*value);
            box->setEnabled(box->isEnabled() && isUsed());
        });
    };
    check("normalizeCheck", tr("&Normalize the direction"),
          tr("The direction has length 1, as section 5.3.4 prints it"), &OptimizeOptions::normalize, isStepped);
    check("coarseCheck", tr("&Rays first"),
          tr("Newton: the first moves along a few thousand rays, the last on the whole volume"),
          &OptimizeOptions::coarse, [isStepped] { return !isStepped(); });
    check("exactSharesCheck", tr("E&xact shares"),
          tr("The shares asked for, even where the picture becomes too faint to see. Otherwise it stays at least 20 % "
             "opaque,\nand what is wanted adds at least 2 % where it is"),
          &OptimizeOptions::exactShares, [] { return true; });
}

void SettingsPanel::addMeasuring(QFormLayout& form) {
    const auto settings = [this]() -> const MeasureSettings& { return *m_services.store().session().measure; };
    form.addRow(heading(tr("Saliency and visibility"), this));
    form.addRow(new ProfileSettings(m_services, this));
    const auto number = [&](const char* id, const QString& label, const Range& range, const QString& tip,
                            const QString& suffix, auto get, auto set) {
        auto* box = numberBox(id, range, tip);
        box->setSuffix(suffix);
        form.addRow(label, box);
        connect(box, &QDoubleSpinBox::valueChanged, this,
                [this, set](double to) { editMeasuring([&](MeasureSettings& m) { set(m, to); }); });
        m_show.push_back([box, get, settings] { showNumber(*box, get(settings())); });
    };
    number(
        "sigmaSpin", tr("σ"), {0.01, 8, 0.1, 2},
        tr("Radius of the centre in reference lengths (voxels, where they are cubes); the surround's is twice it"),
        tr(" d0"), [](const MeasureSettings& m) { return m.saliency.sigma; },
        [](MeasureSettings& m, double to) { m.saliency.sigma = to; });

    const auto combo = [&](const char* id, const QString& label, const QString& tip,
                           const std::vector<std::pair<QString, int>>& items, auto get, auto set) {
        auto* box = new QComboBox;
        box->setObjectName(id);
        for (const auto& [text, value] : items) box->addItem(text, value);
        box->setToolTip(tip);
        form.addRow(label, box);
        connect(box, &QComboBox::activated, this,
                [this, box, set] { editMeasuring([&](MeasureSettings& m) { set(m, box->currentData().toInt()); }); });
        m_show.push_back([box, get, settings] { box->setCurrentIndex(box->findData(get(settings()))); });
    };
    combo(
        "kernelCombo", tr("&Kernel"),
        tr("Weights within the radius: exp(−d²/(2σ)²), eq. 4.7; or a Gaussian of √2/8 of the radius, as the author's\n"
           "published programs have it"),
        {{tr("Thesis (4.7)"), static_cast<int>(SaliencyKernel::Thesis)},
         {tr("Narrow"), static_cast<int>(SaliencyKernel::Narrow)}},
        [](const MeasureSettings& m) { return static_cast<int>(m.saliency.kernel); },
        [](MeasureSettings& m, int to) { m.saliency.kernel = static_cast<SaliencyKernel>(to); });
    number(
        "w1Spin", tr("w1"), {0, 1e6, 0.1, 3}, tr("Weight of the centre in |w1·G(σ) − w2·G(2σ)|, eq. 4.8, no unit"), {},
        [](const MeasureSettings& m) { return m.saliency.w1; },
        [](MeasureSettings& m, double to) { m.saliency.w1 = to; });
    number(
        "w2Spin", tr("w2"), {0, 1e6, 0.1, 3}, tr("Weight of the surround, eq. 4.8, no unit"), {},
        [](const MeasureSettings& m) { return m.saliency.w2; },
        [](MeasureSettings& m, double to) { m.saliency.w2 = to; });
    number(
        "u1Spin", tr("u1, brightness"), {0, 1, 0.05, 3},
        tr("Share of brightness in VWS, eq. 4.13; u1 and u2 add up to 1"), {},
        [](const MeasureSettings& m) { return m.vws.u1; },
        [](MeasureSettings& m, double to) {
            m.vws = {to, 1 - to};
        });
    number(
        "u2Spin", tr("u2, saturation"), {0, 1, 0.05, 3},
        tr("Share of saturation in VWS, eq. 4.13; u1 and u2 add up to 1"), {},
        [](const MeasureSettings& m) { return m.vws.u2; },
        [](MeasureSettings& m, double to) {
            m.vws = {1 - to, to};
        });
    auto* background = new QPushButton;
    background->setObjectName("saliencyBackground");
    background->setToolTip(
        tr("Colour that voxels in no feature have to saliency; the picture's background is another"));
    form.addRow(tr("Surroundings"), background);
    connect(background, &QPushButton::clicked, this, &SettingsPanel::chooseBackground);
    m_show.push_back([background, settings] {
        const QColor color = colorFromRgb(settings().saliency.background);
        QPixmap swatch(28, 12);
        swatch.fill(color);
        background->setIcon(QIcon(swatch));
        background->setText(color.name());
    });
    combo(
        "qualityCombo", tr("&Quality"), tr("High: about half the error of visibility for twice the time and more"),
        {{tr("Normal"), static_cast<int>(Quality::Normal)}, {tr("High"), static_cast<int>(Quality::High)}},
        [](const MeasureSettings& m) { return static_cast<int>(m.quality); },
        [](MeasureSettings& m, int to) { m.quality = static_cast<Quality>(to); });
    combo(
        "engineCombo", tr("&Engine"), tr("What computes visibility; all agree within their tolerances"),
        {{tr("Automatic"), static_cast<int>(EngineChoice::Auto)},
         {tr("OpenGL"), static_cast<int>(EngineChoice::Gl)},
         {tr("CPU"), static_cast<int>(EngineChoice::Cpu)},
         {tr("Slices, as in the thesis"), static_cast<int>(EngineChoice::Slices)},
         {tr("Reference (slow)"), static_cast<int>(EngineChoice::Reference)}},
        [](const MeasureSettings& m) { return static_cast<int>(m.engine); },
        [](MeasureSettings& m, int to) { m.engine = static_cast<EngineChoice>(to); });
}

void SettingsPanel::chooseBackground() {
    const Rgb now = m_services.store().session().measure->saliency.background;
    const QColor color = QColorDialog::getColor(colorFromRgb(now), this, tr("Colour of the surroundings"));
    if (color.isValid()) editMeasuring([&](MeasureSettings& m) { m.saliency.background = rgbFromColor(color); });
}

void SettingsPanel::follow() {
    m_showing = true;
    const bool ready = m_services.isEditable();
    for (QWidget* widget : findChildren<QWidget*>()) {
        const bool isControl = qobject_cast<QComboBox*>(widget) || qobject_cast<QAbstractSpinBox*>(widget) ||
                               qobject_cast<QAbstractButton*>(widget);
        if (isControl && !qobject_cast<ProfileSettings*>(widget->parentWidget())) widget->setEnabled(ready);
    }
    for (const auto& show : m_show) show();
    m_showing = false;
}

} // namespace pellucid::gui
