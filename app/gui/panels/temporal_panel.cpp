#include "panels/temporal_panel.h"

#include <algorithm>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/plot_words.h"
#include "render/feature_pictures.h"
#include "session/scene_data.h"
#include "tf/tf_range.h"
#include "widgets/layouts.h"
#include "widgets/number_text.h"
#include "widgets/plot_view.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

enum Shown { kVws, kVisibility, kOpacity, kPicture };

constexpr int kPictureSize = 512; ///< pixels of the side of the pictures that 2DFS is of
constexpr int kLeastPlot = 120;   ///< logical pixels: four of them and the panel Time are as wide as a window of 1280

bool same(const std::shared_ptr<const TransferFunction>& a, const std::shared_ptr<const TransferFunction>& b) {
    return a == b || (a != nullptr && b != nullptr && *a == *b);
}

} // namespace

PanelInfo temporalPanel() {
    return {.id = "temporal",
            .title = QObject::tr("Curves over time"),
            .group = PanelGroup::Time,
            .area = Qt::BottomDockWidgetArea,
            .visible = false,
            .tabOf = "tf",
            .keys = QKeySequence("Ctrl+4"),
            .tip = QObject::tr("Attention, visibility, distance and flicker of all frames, with and without transfer "
                               "functions that follow them"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new TemporalPanel(services, controllers.player, controllers.adapting, parent);
            }};
}

TemporalPanel::TemporalPanel(Services& services, PlayerController& player, AdaptController& adapting, QWidget* parent)
    : QWidget(parent), m_services(services), m_player(player), m_adapting(adapting),
      m_job([this](const Task& task, const JobControl& job) { return figuresFor(task, job); },
            [this](const Task& task, Known& known) {
                if (m_services.scene().series == task.basis.series) m_known[task.frame] = std::move(known);
                refresh();
                next();
            },
            WhenBusy::StopOld, &m_lane) {
    auto* plots = makePlots();
    m_shown->addItems({{}, {}, {}, {}});
    const auto nameFigures = [this] {
        const QString names[] = {terms().attention(), terms().visibility(), tr("Opacity"), terms().pictureSaliency()};
        for (int i = 0; i < m_shown->count(); ++i) m_shown->setItemText(i, names[i]);
        refresh();
    };
    connect(&terms(), &Terms::changed, this, nameFigures);
    m_progress->setMaximumSize(120, 12);
    m_readOut->setTextInteractionFlags(Qt::TextSelectableByMouse);
    makeFaint(*m_readOut);
    m_readOut->hide();
    auto* row = rowOf({m_shown, m_overGaps, m_measure, m_progress, {m_words, 3}, {m_readOut, 2}, m_export});
    setLayout(inset(columnOf({{plots, 1}, row}, 2), {4, 4, 4, 2}));

    connect(m_shown, &QComboBox::activated, this, [this] {
        refresh();
        next();
    });
    connect(m_overGaps, &QCheckBox::toggled, this, [this] {
        refresh();
        next();
    });
    connect(m_measure, &QToolButton::clicked, this, [this] { m_asked ? cancel() : measure(); });
    connect(m_export, &QToolButton::clicked, this, &TemporalPanel::chooseFile);
    connect(&services.store(), &SessionStore::changed, this, &TemporalPanel::follow);
    connect(&adapting, &AdaptController::changed, this, &TemporalPanel::next);
    connect(&services, &Services::readOnlyChanged, this, [this] {
        if (m_services.isReadOnly()) m_job.cancel();
        next();
    });
    connect(&m_job, &JobBase::failed, this, [this](const Error& error) {
        m_asked = false;
        m_services.showError(tr("The frames cannot be measured"), error);
        refresh();
    });
    nameFigures();
}

TemporalPanel::Known TemporalPanel::figuresFor(const Task& task, const JobControl& job) {
    Known known = task.known;
    const JobControl quiet{job.stop, {}};
    try {
        Scene scene = sceneAt(task.basis, task.frame, *known.tf, quiet);
        const ValueRange window = scene.volume->range();
        const auto written = [&](const TransferFunction& tf) {
            return tf.range && window.lo < window.hi ? inRange(tf, window) : tf;
        };
        const auto measured = [&](const std::shared_ptr<const TransferFunction>& tf,
                                  const std::shared_ptr<const TransferFunction>& before) {
            scene.tf = written(*tf);
            const auto was = before ? std::optional(written(*before)) : std::nullopt;
            FrameFigures figures = figuresOf(scene, was ? &*was : nullptr, m_workspace, quiet);
            if (known.pictured) {
                const PictureInput picture = pictureInput(scene, kPictureSize, kPictureSize);
                const auto renderer = makeCpuRenderer(picture.volume);
                figures.fs = featureSaliency(
                                 featurePictures(*renderer, picture.camera, picture.tf, picture.settings, quiet), quiet)
                                 .shares;
            }
            return figures;
        };
        known.dynamic = measured(known.tf, known.before);
        known.fixed = same(known.tf, known.fixedTf) && same(known.before, known.fixedBefore)
                          ? known.dynamic
                          : measured(known.fixedTf, known.fixedBefore);
    } catch (const FileError&) {
        known.dynamic = known.fixed = brokenFigures(*task.basis.series, task.frame);
    }
    return known;
}

QLayout* TemporalPanel::makePlots() {
    const std::pair<const char*, QString> plots[] = {
        {"temporalDynamic",
         tr("Under the transfer functions that follow the frames: the share of each feature of what\n"
            "catches the eye, 0 to 1 (VWS; dashed: the targets), its visibility (FV), the opacity\n"
            "of its peak, or its share of what catches the eye in the picture (2DFS).\n"
            "Double-click: export.")},
        {"temporalStatic", tr("The same under the keys alone, as in the mode static")},
        {"temporalObjective", tr("F, the root mean square distance of the features' VWS from their targets")},
        {"temporalFlicker", tr("Flicker: mean colour difference ΔE (CIELAB) per pixel between a frame under its\n"
                               "transfer function and the same frame under that of the frame before")}};
    QHBoxLayout* const row = rowOf({});
    for (std::size_t i = 0; i < m_plots.size(); ++i) {
        PlotView* const plot = m_plots[i] = named(new PlotView(this), plots[i].first, plots[i].second);
        connect(plot, &PlotView::readOut, m_readOut, [label = m_readOut](const QString& text) {
            label->setText(text);
            label->setVisible(!text.isEmpty()); // while it says nothing the words beside it have its room
        });
        connect(plot, &PlotView::exportWanted, this, &TemporalPanel::chooseFile);
        plot->setMinimumWidth(kLeastPlot);
        row->addWidget(plot, 1);
    }
    return row;
}

TemporalPanel::Task TemporalPanel::taskOf(int frame) const {
    const Scene& scene = m_services.store().committed();
    const Session& session = scene.session;
    const TfTrack& track = session.variable().track;
    Task task{scene, frame, {}};
    Known& known = task.known;
    known.measure = *session.measure;
    known.camera = scene.camera;
    known.clipping = *session.clipping;
    known.hsb = *session.hsb;
    known.variables = session.variables;
    known.ground = *session.ground;
    known.display = *session.display;
    known.window = scene.volume->range();
    known.pictured = m_shown->currentIndex() == kPicture;
    known.tf = session.tfAt(frame);
    known.fixedTf = track.at(frame);
    if (const int before = neighbourBefore(*scene.series, frame, isOverGaps()); before >= 0) {
        known.before = session.tfAt(before);
        known.fixedBefore = track.at(before);
    }
    if (known.tf) known.targets = targetsOf(*known.tf, goalsAt(session, frame));
    return task;
}

bool TemporalPanel::isOverGaps() const { return m_overGaps->isChecked(); }

bool TemporalPanel::isCurrent(const Known& known, const Known& wanted) {
    return known.measure == wanted.measure && known.camera == wanted.camera && known.clipping == wanted.clipping &&
           known.hsb == wanted.hsb && (!known.hsb.on || sameData(*known.variables, *wanted.variables)) &&
           known.ground == wanted.ground && known.display == wanted.display && known.window == wanted.window &&
           (known.pictured || !wanted.pictured) && known.targets == wanted.targets && same(known.tf, wanted.tf) &&
           same(known.before, wanted.before) && same(known.fixedTf, wanted.fixedTf) &&
           same(known.fixedBefore, wanted.fixedBefore);
}

bool TemporalPanel::isKnown(int frame) const {
    const auto found = m_known.find(frame);
    return found != m_known.end() &&
           found->second.camera == m_services.scene().camera && // most often told by that alone
           isCurrent(found->second, taskOf(frame).known);
}

int TemporalPanel::knownCount() const {
    int known = 0;
    for (const auto& [frame, figures] : m_known) known += isKnown(frame) ? 1 : 0;
    return known;
}

TemporalCurves TemporalPanel::curves() const {
    TemporalCurves curves;
    if (!m_player.hasSeries()) return curves;
    const Scene& scene = m_services.scene();
    for (const Feature& f : scene.tf.features) {
        curves.features.push_back(f.name);
        curves.colors.push_back(f.color);
    }
    const AdaptSettings::Mode mode = scene.session.adapt->mode;
    if (mode != AdaptSettings::Mode::Static) curves.runs.push_back({name(mode), {}});
    curves.runs.push_back({name(AdaptSettings::Mode::Static), {}});
    for (const auto& [frame, known] : m_known) {
        if (!isKnown(frame)) continue;
        curves.runs.front().frames.push_back(known.dynamic);
        if (curves.runs.size() > 1) curves.runs.back().frames.push_back(known.fixed);
    }
    curves.present = scene.session.frame;
    return curves;
}

void TemporalPanel::measure() {
    if (!m_player.hasSeries()) return;
    m_asked = true;
    next();
    refresh();
}

void TemporalPanel::cancel() {
    m_asked = false;
    m_job.cancel();
    refresh();
}

void TemporalPanel::next() {
    if (!m_asked || m_job.isRunning() || !m_player.hasSeries() || m_services.isReadOnly()) return;
    bool waits = false;
    for (int f = 0; f < m_player.frameCount(); ++f) {
        if (isKnown(f)) continue;
        // Its transfer function is on its way.
        if (m_adapting.isBusy() && m_adapting.isStale(f)) {
            waits = true;
            continue;
        }
        if (Task task = taskOf(f); task.known.tf && task.known.fixedTf) {
            m_job.start(std::move(task), m_player.label(f));
            return;
        }
    }
    if (waits) return;
    m_asked = false;
    refresh();
}

void TemporalPanel::follow(const Scene& before, const Scene& after) {
    if (before.series != after.series) {
        m_job.cancel();
        m_known.clear();
        m_asked = false;
    }
    if (isVisible() || m_asked) refresh();
    next();
}

void TemporalPanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    refresh();
}

std::vector<Plot> TemporalPanel::plots() const {
    const TemporalCurves now = curves();
    if (now.runs.empty()) return {};
    const auto plotOf = [&](std::size_t run) {
        switch (m_shown->currentIndex()) {
        case kVisibility:
            return temporalVisibilityPlot(now, run);
        case kOpacity:
            return temporalOpacityPlot(now, run);
        case kPicture:
            return temporalPicturePlot(now, run);
        default:
            double highest = 0;
            for (std::size_t r = 0; r < now.runs.size(); ++r) highest = std::max(highest, temporalVwsPlot(now, r).y.hi);
            return temporalVwsPlot(now, run, highest);
        }
    };
    std::vector<Plot> all{plotOf(0)};
    if (now.runs.size() > 1) all.push_back(plotOf(1));
    all.push_back(temporalObjectivePlot(now));
    all.push_back(temporalFlickerPlot(now));
    return all;
}

QString TemporalPanel::words(int known) const {
    if (!m_player.hasSeries()) return tr("Open a series, and its curves are drawn here.");
    if (known == 0) return m_asked ? tr("Measuring…") : tr("Measure the frames, and their curves are drawn here.");
    QStringList words;
    for (const TemporalRun& run : curves().runs) {
        const double tolerance = m_services.scene().session.optimize->tolerance;
        const SequenceFigures sum = summaryOf(run.frames, tolerance);
        if (sum.worst < 0) continue; // no frame could be read
        const QString above =
            sum.above == 0 ? QString() : tr(", %L1 more than %2").arg(sum.above).arg(terms().distanceText(tolerance));
        words << tr("%1: %2 (most %3, frame %4%5), flicker %6")
                     .arg(QString::fromStdString(run.name), terms().offTarget(sum.rms),
                          terms().distanceText(sum.worstObjective))
                     .arg(sum.worst)
                     .arg(above, shortNumber(sum.flicker));
    }
    const int count = m_player.frameCount();
    if (known < count) words << tr("%L1 of %L2 frames").arg(known).arg(count);
    return words.join("; ");
}

void TemporalPanel::refresh() {
    const bool series = m_player.hasSeries();
    const int count = m_player.frameCount(), known = series ? knownCount() : 0;
    m_measure->setEnabled(series && (m_asked || known < count));
    m_measure->setText(m_asked ? tr("Stop") : tr("Measure all frames"));
    m_measure->setToolTip(m_asked
                              ? tr("Stop measuring; the frames measured so far are kept")
                              : tr("Attention, visibility and flicker of every frame that is not known as it is now,\n"
                                   "from the present camera"));
    m_progress->setVisible(m_asked);
    m_progress->setRange(0, std::max(1, count));
    m_progress->setValue(known);
    m_export->setEnabled(known > 0);
    m_words->setText(words(known));
    if (!isVisible()) return;
    std::vector<Plot> all = plots();
    const bool two = all.size() == m_plots.size();
    m_plots[1]->setVisible(two);
    if (known == 0) all.clear();
    if (!two && !all.empty()) all.insert(all.begin() + 1, Plot());
    all.resize(m_plots.size());
    for (std::size_t p = 0; p < m_plots.size(); ++p) m_plots[p]->setPlot(inWords(std::move(all[p])));
}

void TemporalPanel::chooseFile() {
    if (!m_player.hasSeries() || knownCount() == 0) return;
    const QString path = askCurveFile(m_services, tr("Export the curves over time"), "curves_over_time");
    if (!path.isEmpty()) exportTo(path);
}

void TemporalPanel::exportTo(const QString& path) {
    exportCurves(
        m_services, path, [this] { return csvOf(curves()); }, [this] { return temporalPlots(curves()); });
}

} // namespace pellucid::gui
