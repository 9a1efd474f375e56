#include "panels/settings_panel.h"

#include <QFormLayout>
#include <QLabel>

#include "panels/panel.h"
#include "panels/profile_settings.h"
#include "panels/setting_rows.h"
#include "services/services.h"
#include "widgets/scrolled.h"

namespace pellucid::gui {
namespace {

constexpr double kUsualCoverage = 0.5; ///< offered while that of the picture is not known

QLabel* heading(const QString& text, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    QFont bold = label->font();
    bold.setBold(true);
    label->setFont(bold);
    return label;
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
}

void SettingsPanel::addOptimization(QFormLayout& form) {
    form.addRow(heading(tr("Optimization"), this));
    auto* rows = new SettingRows(m_services, form, settingPart<OptimizeOptions>(&Session::optimize),
                                 {tr("Optimization settings"), "optimize-settings"});
    rows->add("direction", {.id = "directionCombo"});
    rows->add("step", {.id = "stepSpin", .decimals = 6, .step = 0.01});
    rows->add("b", {.id = "bSpin", .decimals = 6, .step = 0.1});
    rows->add("tolerance", {.id = "toleranceSpin", .decimals = 6, .step = 0.01});
    rows->add("max_iterations", {.id = "mostMovesSpin"});
    rows->add("coverage", {.id = "coverageSpin", .decimals = 3, .automatic = [this] {
                               const Measures* const now = m_services.results().measures();
                               return now && now->coverage ? now->coverage->coverage : kUsualCoverage;
                           }});
    connect(&m_services.results(), &Results::changed, rows, &SettingRows::follow);
    rows->add("normalize", {.id = "normalizeCheck"});
    rows->add("coarse", {.id = "coarseCheck"});
    rows->add("restarts", {.id = "restartsCheck"});
    rows->add("exact_shares", {.id = "exactSharesCheck"});
    rows->follow();
}

void SettingsPanel::addMeasuring(QFormLayout& form) {
    const RowStep step{tr("Settings of the figures"), "measure-settings"};
    form.addRow(heading(tr("Saliency and visibility"), this));
    form.addRow(new ProfileSettings(m_services, this));
    auto* saliency = new SettingRows(m_services, form,
                                     settingPart<SaliencyOptions>(&Session::measure, &MeasureSettings::saliency), step);
    saliency->add("sigma", {.id = "sigmaSpin", .decimals = 3, .step = 0.1});
    saliency->add("kernel", {.id = "kernelCombo"});
    saliency->add("w1", {.id = "w1Spin", .decimals = 6, .step = 0.1});
    saliency->add("w2", {.id = "w2Spin", .decimals = 6, .step = 0.1});
    saliency->add("background", {.id = "saliencyBackground"});
    auto* shares =
        new SettingRows(m_services, form, settingPart<VwsOptions>(&Session::measure, &MeasureSettings::vws), step);
    const auto sharesOf = [](void* options) -> VwsOptions& { return *static_cast<VwsOptions*>(options); };
    shares->add("u1", {.id = "u1Spin", .decimals = 6, .then = [=](void* o) { sharesOf(o).u2 = 1 - sharesOf(o).u1; }});
    shares->add("u2", {.id = "u2Spin", .decimals = 6, .then = [=](void* o) { sharesOf(o).u1 = 1 - sharesOf(o).u2; }});
    auto* engine = new SettingRows(m_services, form, settingPart<MeasureSettings>(&Session::measure), step);
    engine->add("quality", {.id = "qualityCombo"});
    engine->add("engine", {.id = "engineCombo"});
    for (SettingRows* rows : {saliency, shares, engine}) rows->follow();
}

} // namespace pellucid::gui
