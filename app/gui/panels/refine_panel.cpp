#include "panels/refine_panel.h"

#include <algorithm>
#include <cmath>

#include <QPainter>

#include "controllers/controllers.h"
#include "optimize/refine/refine_features.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "widgets/layouts.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr double kMargin = 10;

/// The energy over the iterations; empty where there is none above 0. `isPresent`: what came of it is still shown.
Plot energyPlot(const RefineResult& result, bool isPresent) {
    Plot plot{.title = QObject::tr("Energy of the edges").toStdString(),
              .x = {.label = QObject::tr("step").toStdString(), .whole = true},
              .y = {.label = {}, .logarithmic = true},
              .series = {}};
    double least = 0, most = 0;
    for (const double e : result.energyCurve)
        if (e > 0) {
            least = least == 0 ? e : std::min(least, e);
            most = std::max(most, e);
        }
    if (least == 0) return plot;
    PlotSeries& curve = plot.series.emplace_back();
    curve.dashed = !isPresent;
    for (std::size_t i = 0; i < result.energyCurve.size(); ++i)
        curve.points.push_back(
            {static_cast<double>(i) * result.energyCurveStride, std::max(result.energyCurve[i], least)});
    plot.x.hi = std::max({1.0, curve.points.back().x, static_cast<double>(result.iterations)});
    plot.y.lo = least / 1.2;
    plot.y.hi = most * 1.2;
    return plot;
}

} // namespace

PanelInfo refinePanel() {
    return {.id = "refinement",
            .title = QObject::tr("Refinement"),
            .group = PanelGroup::Shares,
            .visible = false,
            .tabOf = "features",
            .keys = QKeySequence("Ctrl+Shift+R"),
            .tip = QObject::tr("Opacities by entropy: how, for what, and what came of it"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new RefinePanel(services, controllers.refining, parent);
            }};
}

EdgeBars::EdgeBars(QWidget* parent) : QWidget(parent), Spoken(*this, QAccessible::Chart) {
    setAccessibleName(tr("Weights of the edges"));
}

void EdgeBars::setBars(std::vector<Bar> bars) {
    m_bars = std::move(bars);
    update();
}

QRectF EdgeBars::cell(std::size_t i) const {
    const double n = static_cast<double>(std::max<std::size_t>(1, m_bars.size()));
    const double each = (width() - 2 * kMargin) / n;
    return {kMargin + static_cast<double>(i) * each, 4, each, height() - 10.0};
}

void EdgeBars::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), theme::kPanel);
    double most = 0, sum = 0, participating = 0;
    for (const Bar& bar : m_bars) {
        most = std::max({most, bar.weight, bar.before.value_or(0)});
        if (!bar.participates) continue;
        sum += bar.weight;
        ++participating;
    }
    painter.setPen(theme::kLine);
    painter.drawLine(QPointF(kMargin, height() - 6), QPointF(width() - kMargin, height() - 6));
    if (!(most > 0)) return;
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(Qt::NoBrush);
    const auto heightOf = [&](double weight, const QRectF& r) { return std::sqrt(weight / most) * r.height(); };
    for (std::size_t i = 0; i < m_bars.size(); ++i) {
        const Bar& bar = m_bars[i];
        const QRectF r = cell(i);
        const double gap = r.width() > 6 ? 1 : 0;
        if (bar.before) {
            const double h = heightOf(*bar.before, r);
            const QRectF pale(r.left() + gap, r.bottom() - h, r.width() - 2 * gap, h);
            painter.fillRect(pale, translucent(bar.color, 0.25));
            painter.setPen(QPen(translucent(bar.color, 0.6), 1));
            painter.drawLine(pale.topLeft(), pale.topRight());
        }
        const double h = heightOf(bar.weight, r), in = bar.before ? 0.22 * r.width() : gap;
        const QRectF box(r.left() + in, r.bottom() - h, r.width() - 2 * in, h);
        painter.fillRect(box, translucent(bar.color, bar.participates ? 1 : 0.45));
        if (contrast(theme::kPanel, bar.color) < kMarkContrast && h > 1) { // nearly white on white
            painter.setPen(QPen(seenOn(theme::kPanel, bar.color), 1));
            painter.drawRect(box.adjusted(0.5, 0.5, -0.5, -0.5));
        }
    }
    if (participating > 0) { // what all of them would be, were they equal
        const QRectF r = cell(0);
        const double y = r.bottom() - heightOf(sum / participating, r);
        painter.setPen(QPen(theme::kText, 1, Qt::DotLine));
        painter.drawLine(QPointF(kMargin, y), QPointF(width() - kMargin, y));
    }
}

bool EdgeBars::event(QEvent* event) {
    return showsTip(*event, *this, [this](const QPoint& at) { return tipAt(at.x()); }) || QWidget::event(event);
}

QStringList EdgeBars::wordsOf(const Bar& bar) const {
    QStringList words{bar.text, tr("weight %1").arg(shortNumber(bar.weight))};
    if (bar.before) words.last() += tr(", before %1").arg(shortNumber(*bar.before));
    if (!bar.participates) words << tr("both ends are fixed: refinement leaves it out");
    return words;
}

QString EdgeBars::spokenValue() const {
    if (m_bars.empty()) return tr("The curve has no edges");
    QStringList parts;
    for (const Bar& bar : m_bars) parts << wordsOf(bar).join(", ");
    return parts.join("; ");
}

QString EdgeBars::tipAt(int x) const {
    for (std::size_t i = 0; i < m_bars.size(); ++i) {
        const QRectF r = cell(i);
        if (x < r.left() || x >= r.right()) continue;
        return wordsOf(m_bars[i]).join('\n');
    }
    return tr("Weight of each edge of the curve: the information −α p ln p between two points.\n"
              "Pale: before the refinement; line: the mean. Heights are square roots");
}

RefinePanel::RefinePanel(Services& services, RefineController& refining, QWidget* parent)
    : QWidget(parent), m_services(services), m_refining(refining),
      m_compare([](const Comparing& task,
                   const JobControl& job) { return compareMethods(*task.histogram, task.start, task.options, job); },
                [this](const Comparing&, RefineComparison& answer) {
                    const double greedy = answer.greedyEnergy, exact = answer.exactEnergy;
                    const double less = greedy > 0 ? 100 * (1 - exact / greedy) : 0;
                    m_comparison->setText(
                        less < 0.01 ? tr("Exact and Greedy give the same result at equal total opacity.")
                                    : tr("At equal total opacity the exact energy is %1 % lower than "
                                         "greedy's: %2, not %3.")
                                          .arg(QString::number(less, 'g', 3), shortNumber(exact), shortNumber(greedy)));
                }) {
    setObjectName("refinePanel");
    m_words->setToolTip(tr("Mean opacity of each feature, before and after; the largest changes first"));
    makeBold(*m_words);
    makeFaint(*m_comparison);
    const RefineActions& does = refining.actions();
    makeFaint(*m_profile);
    m_profile->setText(tr("Published definitions (Settings): edges weigh by whole bins, in steps of 1/255."));
    auto* form = m_form = new QFormLayout;
    form->setVerticalSpacing(5);
    QLayout* const selecting = rowOf({{regionButton(*does.rectangle, tr("Select rectangle")), 1},
                                      {regionButton(*does.lasso, tr("Select with lasso")), 1}});
    fillScrolled(this,
                 columnOf({rowOf({{m_refine, 1}, m_live}), rowOf({{m_priority, 1}, m_nothing}), selecting, m_words,
                           m_note, m_help, m_figures, m_edges, m_plot, m_comparison, rowOf({{m_ghost, 1}, m_pair}),
                           m_profile, form, // what came of it is looked at more often
                           Cell::rest()},
                          7));
    auto* rows = new SettingRows(services, *form, settingPart<RefineSteps>(&Session::refine),
                                 {tr("Refinement settings"), "refine-settings"});
    rows->add("method", {.id = "refineMethodCombo"});
    RowLook step{.id = "refineStepDown", .decimals = 3, .step = 0.25, .factor = 256, .suffix = tr(" / 256")};
    rows->add("step_down", step);
    m_steps.push_back(form->rowCount() - 1);
    step.id = "refineStepUp";
    step.automatic = [&services] { return services.store().session().refine->stepDown; };
    rows->add("step_up", step);
    m_steps.push_back(form->rowCount() - 1);
    rows->add("max_iterations", {.id = "refineLimit"});
    rows->follow();

    const std::pair<QAbstractButton*, QAction*> triggers[] = {{m_refine, does.refine},
                                                              {m_live, does.live},
                                                              {m_pair, does.pair},
                                                              {m_ghost, does.ghost},
                                                              {m_nothing, does.nothing}};
    for (const auto& [button, action] : triggers) connect(button, &QAbstractButton::clicked, action, &QAction::trigger);
    connect(m_help, &QPushButton::clicked, this, [this] { m_refining.takeHelp(); });
    connect(&refining, &RefineController::refined, this, &RefinePanel::follow);
    connect(&refining, &RefineController::busyChanged, this, &RefinePanel::showPriority);
    connect(&refining, &RefineController::ghostChanged, this, &RefinePanel::follow);
    followParts(
        m_services, this, [this] { follow(); }, &Session::refine, &Session::measure);
}

QToolButton* RefinePanel::regionButton(QAction& action, const QString& text) {
    QToolButton* const button =
        named(toolButton(text, this), action.objectName().replace("Action", "Button"), action.toolTip());
    button->setCheckable(true);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    connect(button, &QToolButton::clicked, &action, &QAction::trigger);
    connect(&action, &QAction::changed, button, [button, &action] {
        button->setChecked(action.isChecked());
        button->setEnabled(action.isEnabled());
    });
    return button;
}

void RefinePanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    showOutcome(); // while hidden it has followed nothing
}

void RefinePanel::follow() {
    showSettings();
    showPriority();
    showOutcome();
}

void RefinePanel::showSettings() {
    const RefineSettings& r = *m_services.store().session().refine;
    const bool published = m_services.store().session().measure->profile == Profile::Published;
    m_profile->setVisible(published);
    for (const int step : m_steps) m_form->setRowVisible(step, !published);
    m_live->setChecked(r.live);
    m_ghost->setChecked(m_refining.isGhostShown());
    for (QWidget* widget : std::initializer_list<QWidget*>{m_refine, m_live})
        widget->setEnabled(m_services.isEditable());
    m_pair->setEnabled(m_refining.latest() != nullptr);
}

void RefinePanel::showPriority() {
    const RefineSettings& r = *m_services.store().session().refine;
    QString text = tr("Prioritized: nothing");
    if (m_refining.isBusy()) {
        text = tr("Looking at the region…");
    } else if (r.intensity && m_services.store().hasVolume()) {
        const Volume& volume = *m_services.scene().volume;
        text = tr("Prioritized: value %1")
                   .arg(numberText(volume.valueOfIntensity(*r.intensity), volume.range().hi - volume.range().lo));
    } else if (r.hue) {
        text = tr("Prioritized: hue %1°").arg(QString::number(*r.hue, 'g', 4));
    } else if (r.region) {
        text = tr("Prioritized: a region");
    }
    m_priority->setText(text);
    m_nothing->setEnabled(r.favoursAny() && !m_services.isReadOnly());
}

std::vector<EdgeBars::Bar> RefinePanel::bars() const {
    const Scene& scene = m_services.scene();
    const Refinement* now = m_refining.current();
    const RefineOptions present = m_refining.options();
    const std::vector<double> weights =
        now != nullptr ? now->result.edgesAfter
                       : edgeWeights(*scene.histogram, scene.tf, present.priority, present.profile);
    RefineOptions bare; // as edgeWeights() has them
    bare.profile = present.profile;
    const std::vector<RefineEdge> edges =
        now != nullptr ? refineEdges(now->start, now->options) : refineEdges(scene.tf, bare);
    const TfSampler sampler(scene.tf);
    const double span = scene.volume->range().hi - scene.volume->range().lo;
    const auto value = [&](double x) { return numberText(scene.volume->valueOfIntensity(x), span); };
    std::vector<EdgeBars::Bar> all;
    for (std::size_t i = 0; i < weights.size() && i < edges.size(); ++i) {
        EdgeBars::Bar bar;
        bar.weight = weights[i];
        if (now != nullptr) bar.before = now->result.edgesBefore[i];
        bar.color = colorFromRgb(sampler.color((edges[i].a + edges[i].b) / 2));
        bar.participates = edges[i].participates;
        bar.text = tr("values %1 to %2").arg(value(edges[i].a), value(edges[i].b));
        all.push_back(std::move(bar));
    }
    return all;
}

void RefinePanel::showOutcome() {
    if (!isVisible()) return;
    m_compare.cancel();
    m_comparison->clear();
    const Scene& scene = m_services.scene();
    if (!scene.volume || !scene.histogram) {
        m_edges->setBars({});
        m_plot->hide();
        m_words->clear();
        showNote(nullptr);
        m_figures->clear();
        return;
    }
    const Refinement* now = m_refining.current();
    const Refinement* any = m_refining.latest();
    m_edges->setBars(bars());
    showNote(any);
    m_words->setEnabled(now != nullptr);
    m_figures->setEnabled(now != nullptr);
    if (any == nullptr) {
        m_words->setText(tr("Not refined yet."));
        m_figures->setText(tr("With even edge weights, every part of the curve tells as much as any other."));
        m_plot->hide();
        return;
    }
    m_words->setText(any->words);
    const RefineResult& result = any->result;
    QString evenness = evennessText(result.energyMovableBefore, result.energyMovableAfter);
    evenness[0] = evenness[0].toUpper();
    m_figures->setText(
        tr("%1: energy %2, from %3, in %L4 steps%5")
            .arg(evenness, shortNumber(result.energyMovableAfter), shortNumber(result.energyMovableBefore))
            .arg(result.iterations)
            .arg(now != nullptr ? tr(".") : tr("; the curve has changed since.")) +
        (any->options.profile == Profile::Published ? tr(" By the published definitions.") : QString()));
    m_plot->setPlot(energyPlot(result, now != nullptr));
    m_plot->setVisible(!m_plot->plot().series.empty());
    if (now != nullptr) m_wait.start();
}

void RefinePanel::showNote(const Refinement* refinement) {
    QStringList sentences;
    const std::optional<Darkening> dark = refinement != nullptr ? refinement->dark : std::nullopt;
    if (refinement != nullptr && !refinement->shortfall.isEmpty()) sentences.append(refinement->shortfall);
    if (dark) sentences.append(QString::fromStdString(darkeningText(*dark)));
    m_note->setText(sentences.join(' '));
    m_note->setVisible(!sentences.isEmpty());
    m_help->setVisible(dark && dark->help != Darkening::Help::None);
    if (!dark) return;
    m_help->setText(dark->help == Darkening::Help::Exact ? tr("Refine by Exact instead")
                                                         : tr("Stop after %L1 steps instead").arg(dark->iterations));
    m_help->setEnabled(refinement == m_refining.current() && !m_services.isReadOnly());
}

void RefinePanel::compare() {
    const Refinement* now = m_refining.current();
    if (now == nullptr || m_services.store().isPreviewing() || !isVisible() || !m_services.scene().histogram) return;
    m_compare.start({m_services.scene().histogram, now->start, now->options}, tr("the comparison"));
}

} // namespace pellucid::gui
