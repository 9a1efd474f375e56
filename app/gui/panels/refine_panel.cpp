#include "panels/refine_panel.h"

#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHelpEvent>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QToolButton>
#include <QToolTip>
#include <QVBoxLayout>

#include "controllers/controllers.h"
#include "optimize/refine/refine_features.h"
#include "panels/panel.h"
#include "panels/setting_rows.h"
#include "services/services.h"
#include "widgets/named.h"
#include "widgets/number_text.h"
#include "widgets/plot_view.h"
#include "widgets/scrolled.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kRest = 300; // milliseconds without a change before the methods are compared
constexpr double kMargin = 10;

QString shortNumber(double value) { return QString::number(value, 'g', 3).replace('-', QChar(0x2212)); }

QColor translucent(QColor color, double alpha) {
    color.setAlphaF(static_cast<float>(alpha));
    return color;
}

QFont smallFont(const QFont& font) {
    QFont small = font;
    small.setPointSizeF(small.pointSizeF() * 0.85);
    return small;
}

/// The energy over the iterations; empty where there is none above 0. `isPresent`: what came of it is still shown.
Plot energyPlot(const RefineResult& result, bool isPresent) {
    Plot plot{.title = QObject::tr("Energy of the edges").toStdString(),
              .x = {.label = QObject::tr("iteration").toStdString(), .whole = true},
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
    return {.id = "refine",
            .title = QObject::tr("Refinement"),
            .area = Qt::RightDockWidgetArea,
            .visible = true,
            .tabOf = "features",
            .size = 0,
            .keys = QKeySequence("Ctrl+Shift+R"),
            .tip = QObject::tr("Opacities by entropy: how, for what, and what came of it"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new RefinePanel(services, controllers.refining, parent);
            }};
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
        painter.fillRect(QRectF(r.left() + in, r.bottom() - h, r.width() - 2 * in, h),
                         translucent(bar.color, bar.participates ? 1 : 0.45));
    }
    if (participating > 0) { // what all of them would be, were they equal
        const QRectF r = cell(0);
        const double y = r.bottom() - heightOf(sum / participating, r);
        painter.setPen(QPen(theme::kText, 1, Qt::DotLine));
        painter.drawLine(QPointF(kMargin, y), QPointF(width() - kMargin, y));
    }
}

bool EdgeBars::event(QEvent* event) {
    if (event->type() != QEvent::ToolTip) return QWidget::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    QString text = tr("Weight of each edge of the curve: the information −α p ln p between two points.\n"
                      "Pale: before the refinement; line: the mean. Heights are square roots");
    for (std::size_t i = 0; i < m_bars.size(); ++i) {
        const QRectF r = cell(i);
        if (help->pos().x() < r.left() || help->pos().x() >= r.right()) continue;
        const Bar& bar = m_bars[i];
        text = tr("%1\nweight %2").arg(bar.text, shortNumber(bar.weight));
        if (bar.before) text += tr(", before %1").arg(shortNumber(*bar.before));
        if (!bar.participates) text += tr("\nboth ends are fixed: refinement leaves it out");
    }
    QToolTip::showText(help->globalPos(), text, this);
    return true;
}

RefinePanel::RefinePanel(Services& services, RefineController& refining, QWidget* parent)
    : QWidget(parent), m_services(services), m_refining(refining), m_refine(new QPushButton(tr("&Refine"), this)),
      m_pair(new QPushButton(tr("&Side by side…"), this)), m_live(new QCheckBox(tr("Li&ve"), this)),
      m_ghost(new QCheckBox(tr("Show the &curve before"), this)), m_priority(new QLabel(this)),
      m_nothing(new QToolButton(this)), m_words(new QLabel(this)), m_note(new QLabel(this)),
      m_figures(new QLabel(this)), m_comparison(new QLabel(this)), m_help(new QPushButton(this)),
      m_edges(new EdgeBars(this)), m_plot(new PlotView(this)),
      m_compare([](const Comparing& task,
                   const JobControl& job) { return compareMethods(*task.histogram, task.start, task.options, job); },
                [this](const Comparing&, RefineComparison& answer) {
                    const double greedy = answer.greedyEnergy, exact = answer.exactEnergy;
                    const double less = greedy > 0 ? 100 * (1 - exact / greedy) : 0;
                    m_comparison->setText(
                        less < 0.01 ? tr("Exact and greedy come to the same at equal total opacity.")
                                    : tr("At equal total opacity the exact energy is %1 % lower than "
                                         "greedy's: %2, not %3.")
                                          .arg(QString::number(less, 'g', 3), shortNumber(exact), shortNumber(greedy)));
                }) {
    setObjectName("refinePanel");
    named(m_refine, "refineNowButton", tr("Refine the opacities with these settings (Ctrl+R)"));
    named(m_pair, "sideBySideButton", tr("The picture before and after the latest refinement"));
    named(m_live, "liveRefineCheck",
          tr("Refine after every edit: what you move stays where you put it,\n"
             "the other points give way evenly, so that the total opacity stays"));
    named(m_ghost, "ghostCheck", tr("Dashed, behind the curve: what it was before the latest refinement"));
    named(m_priority, "refinePriority",
          tr("What becomes more opaque, relative to everything else. Click on the palette below the\n"
             "curve for a value, or select a part of the picture"));
    m_nothing->setObjectName("clearPriorityButton");
    m_nothing->setText(tr("Clear"));
    m_nothing->setToolTip(tr("Give no value or region priority; the opacities stay as they are"));
    m_edges->setObjectName("refineEdges");
    named(m_plot, "refineCurve", tr("Energy, the variance of the edge weights, over the iterations; logarithmic"));
    const std::pair<QLabel*, const char*> labels[] = {{m_words, "refineWords"},
                                                      {m_note, "refineNote"},
                                                      {m_figures, "refineFigures"},
                                                      {m_comparison, "refineComparison"}};
    for (const auto& [label, name] : labels) {
        label->setObjectName(name);
        label->setWordWrap(true);
        label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred); // what is said makes nothing wider
    }
    m_priority->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    m_words->setToolTip(tr("Mean opacity of each feature, before and after; the largest changes first"));
    QFont bold = font();
    bold.setBold(true);
    m_words->setFont(bold);
    makeFaint(*m_comparison);

    auto* content = new QWidget;
    auto* column = new QVBoxLayout(content);
    column->setContentsMargins(10, 8, 10, 8);
    column->setSpacing(7);
    auto* head = new QHBoxLayout;
    head->addWidget(m_refine, 1);
    head->addWidget(m_live);
    column->addLayout(head);
    auto* priority = new QHBoxLayout;
    priority->addWidget(m_priority, 1);
    priority->addWidget(m_nothing);
    column->addLayout(priority);
    auto* selecting = new QHBoxLayout;
    const RefineActions& does = refining.actions();
    for (const auto& [action, text] :
         {std::pair{does.rectangle, tr("Select rectangle")}, std::pair{does.lasso, tr("Select with lasso")}}) {
        auto* button = new QToolButton(this);
        button->setObjectName(action->objectName().replace("Action", "Button"));
        button->setText(text);
        button->setToolTip(action->toolTip());
        button->setCheckable(true);
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        connect(button, &QToolButton::clicked, action, &QAction::trigger);
        connect(action, &QAction::changed, button, [button, action = action] {
            button->setChecked(action->isChecked());
            button->setEnabled(action->isEnabled());
        });
        selecting->addWidget(button, 1);
    }
    column->addLayout(selecting);
    auto* form = new QFormLayout;
    form->setVerticalSpacing(5);
    column->addWidget(m_words);
    column->addWidget(m_note);
    column->addWidget(m_help);
    column->addWidget(m_figures);
    column->addWidget(m_edges);
    column->addWidget(m_plot);
    column->addWidget(m_comparison);
    auto* foot = new QHBoxLayout;
    foot->addWidget(m_ghost, 1);
    foot->addWidget(m_pair);
    column->addLayout(foot);
    column->addLayout(form); // what came of it is looked at more often
    column->addStretch(1);
    fillScrolled(this, content);
    auto* rows = new SettingRows(services, *form, settingPart<RefineSteps>(&Session::refine),
                                 {tr("Refinement settings"), "refine-settings"});
    rows->add("method", {.id = "refineMethodCombo"});
    RowLook step{.id = "refineStepDown", .decimals = 3, .step = 0.25, .factor = 256, .suffix = tr(" / 256")};
    rows->add("step_down", step);
    step.id = "refineStepUp";
    step.automatic = [&services] { return services.store().session().refine->stepDown; };
    rows->add("step_up", step);
    rows->add("max_iterations", {.id = "refineLimit"});
    rows->follow();

    const std::pair<QAbstractButton*, QAction*> triggers[] = {{m_refine, does.refine},
                                                              {m_live, does.live},
                                                              {m_pair, does.pair},
                                                              {m_ghost, does.ghost},
                                                              {m_nothing, does.nothing}};
    for (const auto& [button, action] : triggers) connect(button, &QAbstractButton::clicked, action, &QAction::trigger);
    m_help->setObjectName("refineHelpButton");
    connect(m_help, &QPushButton::clicked, this, [this] { m_refining.takeHelp(); });
    m_wait.setSingleShot(true);
    m_wait.setInterval(kRest);
    connect(&m_wait, &QTimer::timeout, this, &RefinePanel::compare);
    connect(&m_services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume || !before.session.refine.isSame(after.session.refine)) follow();
    });
    connect(&refining, &RefineController::refined, this, &RefinePanel::follow);
    connect(&refining, &RefineController::busyChanged, this, &RefinePanel::showPriority);
    connect(&refining, &RefineController::ghostChanged, this, &RefinePanel::follow);
    connect(&m_services, &Services::readOnlyChanged, this, &RefinePanel::follow);
    follow();
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
    } else if (r.region) {
        text = tr("Prioritized: a region");
    }
    m_priority->setText(text);
    m_nothing->setEnabled((r.intensity || r.region) && !m_services.isReadOnly());
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
    const std::vector<double> weights = now != nullptr
                                            ? now->result.edgesAfter
                                            : edgeWeights(*scene.histogram, scene.tf, m_refining.options().priority);
    const std::vector<RefineEdge> edges =
        now != nullptr ? refineEdges(now->start, now->options) : refineEdges(scene.tf);
    const TfSampler sampler(scene.tf);
    const double span = scene.volume->range().hi - scene.volume->range().lo;
    const auto value = [&](double x) { return numberText(scene.volume->valueOfIntensity(x), span); };
    std::vector<EdgeBars::Bar> bars;
    for (std::size_t i = 0; i < weights.size() && i < edges.size(); ++i) {
        EdgeBars::Bar bar;
        bar.weight = weights[i];
        if (now != nullptr) bar.before = now->result.edgesBefore[i];
        bar.color = colorFromRgb(sampler.color((edges[i].a + edges[i].b) / 2));
        bar.participates = edges[i].participates;
        bar.text = tr("values %1 to %2").arg(value(edges[i].a), value(edges[i].b));
        bars.push_back(std::move(bar));
    }
    m_edges->setBars(std::move(bars));
    showNote(any);
    m_words->setEnabled(now != nullptr);
    m_figures->setEnabled(now != nullptr);
    if (any == nullptr) {
        m_words->setText(tr("Not refined yet."));
        m_figures->setText(tr("Even edge weights mean: every part of the curve tells as much as any other."));
        m_plot->hide();
        return;
    }
    m_words->setText(any->words);
    const RefineResult& result = any->result;
    QString evenness = evennessText(result.energyMovableBefore, result.energyMovableAfter);
    evenness[0] = evenness[0].toUpper();
    m_figures->setText(
        tr("%1: energy %2, from %3, in %L4 iterations%5")
            .arg(evenness, shortNumber(result.energyMovableAfter), shortNumber(result.energyMovableBefore))
            .arg(result.iterations)
            .arg(now != nullptr ? tr(".") : tr("; the curve has changed since.")));
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
    m_help->setText(dark->help == Darkening::Help::Exact
                        ? tr("Refine by Exact instead")
                        : tr("Stop after %L1 iterations instead").arg(dark->iterations));
    m_help->setEnabled(refinement == m_refining.current() && !m_services.isReadOnly());
}

void RefinePanel::compare() {
    const Refinement* now = m_refining.current();
    if (now == nullptr || m_services.store().isPreviewing() || !isVisible() || !m_services.scene().histogram) return;
    m_compare.start({m_services.scene().histogram, now->start, now->options}, tr("the comparison"));
}

} // namespace pellucid::gui
