// How figures are computed and how optimizations search: all settings that they depend on, as edits of the session.
#include <QCheckBox>
#include <QComboBox>
#include <QPushButton>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/setting_rows.h"
#include "render/published_engine.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kUsualCoverage = 0.5; ///< offered while that of the picture is not known

void addHeading(QFormLayout& form, const QString& text) {
    auto* label = new QLabel(text);
    makeBold(*label);
    form.addRow(label);
}

void addOptimization(Services& services, QFormLayout& form) {
    addHeading(form, QObject::tr("Optimization"));
    auto* rows = new SettingRows(services, form, settingPart<OptimizeOptions>(&Session::optimize),
                                 {QObject::tr("Optimization settings"), "optimize-settings"});
    rows->add("direction", {.id = "directionCombo"});
    rows->add("step", {.id = "stepSpin", .decimals = 6, .step = 0.01});
    rows->add("b", {.id = "bSpin", .decimals = 6, .step = 0.1});
    rows->add("tolerance", {.id = "toleranceSpin", .decimals = 6, .step = 0.01});
    rows->add("max_iterations", {.id = "mostMovesSpin"});
    rows->add("coverage", {.id = "coverageSpin", .decimals = 3, .automatic = [&services] {
                               const Measures* const now = services.results().measures();
                               return now && now->coverage ? now->coverage->coverage : kUsualCoverage;
                           }});
    QObject::connect(&services.results(), &Results::changed, rows, &SettingRows::follow);
    rows->add("normalize", {.id = "normalizeCheck"});
    rows->add("coarse", {.id = "coarseCheck"});
    rows->add("restarts", {.id = "restartsCheck"});
    rows->add("exact_shares", {.id = "exactSharesCheck"});
    rows->follow();
}

/// Whether the picture shows what the figures are of, but for its size.
bool looksAlong(const Camera& camera, const Geometry& geometry, Along along) {
    const Vec3 off = camera.forward() - cameraAlong(geometry, along).forward();
    return camera.projection == Projection::Orthographic && dot(off, off) < 1e-12;
}

/// Pellucid's own definitions or the published ones, and for those the face of the grid that they look at; a remark
/// where the picture does not show that face, and a button to go there.
void addDefinitions(Services& services, OpenController& opening, QFormLayout& form) {
    auto* rows = new SettingRows(services, form, settingPart<MeasureSettings>(&Session::measure),
                                 {QObject::tr("Definitions of figures"), "profile"});
    // Volatility has another definition then: its frames are gone through off this thread.
    rows->setCommit([&](const QString& text, const QString& mergeKey, const SessionStore::Change& change) {
        if (services.scene().colors || (services.store().hasVolume() && services.scene().session.variable().derivation))
            opening.editInJob(text, change);
        else
            services.store().edit(text, mergeKey, change);
    });
    rows->add("profile", {.id = "profileCombo"});
    auto* along = static_cast<QComboBox*>(rows->add("along", {.id = "alongCombo"}));
    rows->follow();
    QLabel* const remark = withAnyWidth(wrappedLabel("profileRemark", form.parentWidget()));
    makeFaint(*remark);
    auto* look = named(new QPushButton(QObject::tr("Look &there")), "lookAlongButton",
                       QObject::tr("Turn the picture to what the figures are of, in parallel projection"));
    look->setAutoDefault(false);
    form.addRow(rowOf({{remark, 1}, look}));
    QObject::connect(look, &QPushButton::clicked, rows, [&services] {
        const Scene& scene = services.scene();
        services.store().setCamera(cameraAlong(scene.volume->geometry(), scene.session.measure->along));
    });
    const auto follow = [=, &services, &form] {
        const Scene& scene = services.scene();
        const MeasureSettings& settings = *scene.session.measure;
        const bool published = settings.profile == Profile::Published;
        const bool elsewhere =
            published && scene.volume && !looksAlong(scene.camera, scene.volume->geometry(), settings.along);
        form.setRowVisible(along, published);
        remark->setText(QObject::tr("Figures are of the %1 of the grid, not of this view.").arg(along->currentText()));
        remark->setVisible(elsewhere);
        look->setVisible(elsewhere);
        look->setEnabled(services.isEditable());
    };
    QObject::connect(&services.store(), &SessionStore::changed, rows, follow);
    QObject::connect(&services, &Services::readOnlyChanged, rows, follow);
    follow();
}

void addMeasuring(Services& services, OpenController& opening, QFormLayout& form) {
    const RowStep step{QObject::tr("Settings of the figures"), "measure-settings"};
    addHeading(form, QObject::tr("Saliency and visibility"));
    addDefinitions(services, opening, form);
    auto* saliency = new SettingRows(services, form,
                                     settingPart<SaliencyOptions>(&Session::measure, &MeasureSettings::saliency), step);
    saliency->add("sigma", {.id = "sigmaSpin", .decimals = 3, .step = 0.1});
    saliency->add("kernel", {.id = "kernelCombo"});
    saliency->add("w1", {.id = "w1Spin", .decimals = 6, .step = 0.1});
    saliency->add("w2", {.id = "w2Spin", .decimals = 6, .step = 0.1});
    saliency->add("background", {.id = "saliencyBackground"});
    auto* shares =
        new SettingRows(services, form, settingPart<VwsOptions>(&Session::measure, &MeasureSettings::vws), step);
    const auto sharesOf = [](void* options) -> VwsOptions& { return *static_cast<VwsOptions*>(options); };
    shares->add("u1", {.id = "u1Spin", .decimals = 6, .then = [=](void* o) { sharesOf(o).u2 = 1 - sharesOf(o).u1; }});
    shares->add("u2", {.id = "u2Spin", .decimals = 6, .then = [=](void* o) { sharesOf(o).u1 = 1 - sharesOf(o).u2; }});
    auto* engine = new SettingRows(services, form, settingPart<MeasureSettings>(&Session::measure), step);
    engine->add("quality", {.id = "qualityCombo"});
    engine->add("engine", {.id = "engineCombo"});
    for (SettingRows* rows : {saliency, shares, engine}) rows->follow();
}

/// What figures are called: a choice of this machine, and always the scientific names with the published profile.
void addNames(Services& services, QFormLayout& form) {
    addHeading(form, QObject::tr("Words"));
    auto* box =
        named(new QCheckBox(QObject::tr("Scientific names")), "scientificNamesCheck",
              QObject::tr("Figures are called VWS, F, visibility and 2DFS in place of attention, off target, seen\n"
                          "and in the picture. Always so with the published profile"));
    form.addRow(box);
    QObject::connect(box, &QCheckBox::toggled, box, [](bool on) { terms().choose(on); });
    const auto follow = [&services, box] {
        const bool published = services.scene().session.measure->profile == Profile::Published;
        terms().setPublished(published);
        const QSignalBlocker quiet(box);
        box->setChecked(terms().areScientific());
        box->setEnabled(!published);
    };
    QObject::connect(&services.store(), &SessionStore::changed, box, follow);
    QObject::connect(&terms(), &Terms::changed, box, follow);
    follow();
}

QWidget* makePanel(Services& services, OpenController& opening, QWidget* parent) {
    auto* panel = named(new QWidget(parent), "settingsPanel");
    QFormLayout* const form = scrolledForm(panel, 5);
    form->setFieldGrowthPolicy(QFormLayout::ExpandingFieldsGrow);
    addOptimization(services, *form);
    addMeasuring(services, opening, *form);
    addNames(services, *form);
    return panel;
}

} // namespace

PanelInfo settingsPanel() {
    return {.id = "settings",
            .title = QObject::tr("Settings"),
            .group = PanelGroup::Files,
            .visible = false,
            .tabOf = "features",
            .keys = QKeySequence("Ctrl+8"),
            .tip = QObject::tr("How visibility and saliency are measured, and how optimizations search"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return makePanel(services, controllers.opening, parent);
            }};
}

} // namespace pellucid::gui
