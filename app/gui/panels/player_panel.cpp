// Time: the frames of a series over their histograms, and what plays them.
#include <cmath>
#include <limits>

#include <QAction>
#include <QMainWindow>
#include <QPainter>
#include <QSlider>

#include "controllers/controllers.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/time_strip.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/dock_title.h"
#include "widgets/fitting_row.h"
#include "widgets/layouts.h"
#include "widgets/number_box.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

enum class Sign { First, Previous, Play, Pause, Next, Last, Loop, Back };

/// Signs of players, in the colour of texts.
QIcon signOf(Sign sign) {
    constexpr int kSide = 32;
    QPixmap pixmap(kSide, kSide);
    pixmap.setDevicePixelRatio(2);
    pixmap.fill(Qt::transparent);
    QPainter p(&pixmap);
    p.setRenderHint(QPainter::Antialiasing);
    p.setPen(Qt::NoPen);
    p.setBrush(theme::kText);
    const auto right = [&](double x, double w) { p.drawPolygon(QPolygonF{{x, 3}, {x + w, 8}, {x, 13}}); };
    const auto left = [&](double x, double w) { p.drawPolygon(QPolygonF{{x + w, 3}, {x, 8}, {x + w, 13}}); };
    const auto bar = [&](double x) { p.drawRect(QRectF(x, 3, 2, 10)); };
    switch (sign) {
    case Sign::First:
        bar(3);
        left(6, 7);
        break;
    case Sign::Previous:
        left(3, 6);
        bar(11);
        break;
    case Sign::Play:
        right(4, 9);
        break;
    case Sign::Pause:
        p.drawRect(QRectF(4, 3, 3, 10));
        p.drawRect(QRectF(9, 3, 3, 10));
        break;
    case Sign::Next:
        bar(3);
        right(7, 6);
        break;
    case Sign::Last:
        right(3, 7);
        bar(11);
        break;
    case Sign::Back:
        left(3, 9);
        break;
    case Sign::Loop:
        p.setBrush(Qt::NoBrush);
        p.setPen(QPen(theme::kText, 1.6));
        p.drawArc(QRectF(3, 3, 10, 10), 60 * 16, 300 * 16);
        p.setPen(Qt::NoPen);
        p.setBrush(theme::kText);
        p.drawPolygon(QPolygonF{{8, 0.5}, {12.5, 4}, {8, 7}});
        break;
    }
    return QIcon(pixmap);
}

// The slider: 0 at the left end, infinity at the right one, logarithmic between them.
constexpr int kCoherenceSteps = 100;
constexpr double kLeastCoherence = 0.01, kMostCoherence = 100;

double coherenceOf(int step) {
    if (step <= 0) return 0;
    if (step >= kCoherenceSteps) return std::numeric_limits<double>::infinity();
    const double t = (step - 1.0) / (kCoherenceSteps - 2.0);
    // To two digits: so are sessions and texts.
    const double value = kLeastCoherence * std::pow(kMostCoherence / kLeastCoherence, t);
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return std::round(value / unit) * unit;
}

int stepOf(double coherence) {
    if (!(coherence > 0)) return 0;
    if (std::isinf(coherence)) return kCoherenceSteps;
    const double t = std::log(coherence / kLeastCoherence) / std::log(kMostCoherence / kLeastCoherence);
    return std::clamp(1 + static_cast<int>(std::lround(t * (kCoherenceSteps - 2))), 1, kCoherenceSteps - 1);
}

QString coherenceText(double coherence) {
    return std::isinf(coherence) ? QStringLiteral("∞") : QString::number(coherence, 'g', 2);
}

/// What goes on by itself: how far it is, and a button that stops it or lets it go on.
struct Work {
    QLabel* text;
    QProgressBar* bar;
    QToolButton* stop;

    Work(const QString& id, QWidget* parent)
        : text(named(new QLabel(parent), id + "Label")), bar(progressBar(id + "Progress", parent, 1000)),
          stop(named(new QToolButton(parent), id + "Stop")) {
        makeFaint(*text);
        bar->setMaximumSize(100, 12);
        stop->setAutoRaise(true);
    }
    void show(double share, bool goesOn, const QString& tip) {
        bar->setToolTip(text->text()); // which has no room in a narrow window
        bar->setValue(static_cast<int>(1000 * share));
        stop->setText(goesOn ? QObject::tr("Stop") : QObject::tr("Go on"));
        stop->setToolTip(tip);
    }
};

/// Comes up by itself where a series is opened, and goes with it.
class PlayerPanel : public QWidget {
public:
    PlayerPanel(Services& services, PlayerController& player, AdaptController& adapting, QWidget* parent);

    /// Puts the frame, and what goes on by itself, into a row around the panel.
    void fill(FittingRow& row);

private:
    void follow(const Scene& before, const Scene& after);
    void followPlayer();
    void followSurvey();
    void followMarks();
    void followAdapting();
    QLayout* playRow();
    QLayout* adaptRow();
    QLayout* keyRow();
    void showDock(bool shown);

    Services& m_services;
    PlayerController& m_player;
    AdaptController& m_adapting;
    TimeStrip* m_strip = new TimeStrip(this);
    QLabel* m_frame = named(new QLabel(this), "frameLabel",
                            tr("The frame that is shown: its time, in the unit of the data, and its number"));
    QLabel* m_rate = named(new QLabel(this), "rateLabel",
                           tr("Frames that were shown a second, of those that were due; frames that could not be read\n"
                              "or drawn in time are dropped"));
    QToolButton* m_play = nullptr;
    QDoubleSpinBox* m_speed =
        named(new QDoubleSpinBox(this), "framesPerSecond", tr("Speed of play, frames a second, 1 to 60"));
    Work m_survey{"survey", this};
    QComboBox* m_mode = named(new QComboBox(this), "adaptMode",
                              tr("How the transfer function follows the frames\n"
                                 "static: the keys, and what lies between them\n"
                                 "refine: that of the frame before, refined by entropy, priorities included\n"
                                 "optimize: opacities bring attention to the targets in every frame"));
    QSlider* m_coherence =
        named(new QSlider(Qt::Horizontal, this), "coherence",
              tr("Coherence, 0 to ∞, without unit: how much jumps of the transfer function from frame to\n"
                 "frame are held back; 0: each frame for itself, ∞: as static\n"
                 "optimize: over the whole series, for a mean distance (RMS) of a hundredth of this from the targets"));
    QLabel* m_coherenceText = named(new QLabel(this), "coherenceLabel");
    Work m_adapt{"adapt", this};
    bool m_shownByItself = false;
};

PlayerPanel::PlayerPanel(Services& services, PlayerController& player, AdaptController& adapting, QWidget* parent)
    : QWidget(parent), m_services(services), m_player(player), m_adapting(adapting) {
    setLayout(inset(columnOf({playRow(), {m_strip, 1}, adaptRow(), keyRow()}, 2), {2, 2, 2, 4}));
    connect(m_strip, &TimeStrip::frameWanted, &player, &PlayerController::goTo);
    connect(m_strip, &TimeStrip::stepWanted, &player, &PlayerController::step);
    connect(&services.store(), &SessionStore::changed, this, &PlayerPanel::follow);
    connect(&player, &PlayerController::changed, this, &PlayerPanel::followPlayer);
    connect(&player, &PlayerController::surveyed, this, &PlayerPanel::followSurvey);
    connect(&player, &PlayerController::heldChanged, this, &PlayerPanel::followMarks);
    connect(&adapting, &AdaptController::changed, this, &PlayerPanel::followAdapting);
    followPlayer();
    followSurvey();
    followAdapting();
}

QLayout* PlayerPanel::playRow() {
    const PlayerActions& does = m_player.actions();
    auto* row = rowOf({}, 2);
    for (const auto& [action, name, sign] : std::initializer_list<std::tuple<QAction*, const char*, Sign>>{
             {does.first, "firstFrame", Sign::First},
             {does.previous, "previousFrame", Sign::Previous},
             {does.play, "play", Sign::Play},
             {does.next, "nextFrame", Sign::Next},
             {does.last, "lastFrame", Sign::Last},
             {does.loops, "loopFrames", Sign::Loop},
             {does.backward, "playBackward", Sign::Back}}) {
        QToolButton* const made = actionButton(*action, name, {}, this);
        made->setIcon(signOf(sign));
        made->setAutoRaise(true);
        if (sign == Sign::Play) m_play = made;
        row->addWidget(made);
    }
    m_speed->setRange(PlayerController::kSlowest, PlayerController::kFastest);
    m_speed->setDecimals(0);
    m_speed->setSuffix(tr(" fps"));
    m_speed->setValue(m_player.speed());
    connect(m_speed, &QDoubleSpinBox::valueChanged, this, [this](double value) { m_player.setSpeed(value); });
    makeFaint(*m_rate);
    withAnyWidth(m_rate)->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    connect(m_survey.stop, &QToolButton::clicked, this,
            [this] { m_player.isSurveying() ? m_player.stopSurvey() : m_player.goOnSurveying(); });
    add(*row, {m_speed, Cell::gap(8), {m_rate, 1}});
    return row;
}

void PlayerPanel::fill(FittingRow& row) {
    row.add(m_frame);
    row.addGap();
    for (const Work* work : {&m_adapt, &m_survey}) { // the stop button stays longest
        row.add(work->text, 2);
        row.add(work->bar, 1);
        row.add(work->stop);
    }
}

QLayout* PlayerPanel::adaptRow() {
    for (const char* mode : settingOf(settingsOf<AdaptSettings>(), "mode").choices) m_mode->addItem(tr(mode));
    connect(m_mode, &QComboBox::activated, this,
            [this](int index) { m_adapting.setMode(static_cast<AdaptSettings::Mode>(index)); });
    m_coherence->setRange(0, kCoherenceSteps);
    m_coherence->setMinimumWidth(50);
    m_coherence->setMaximumWidth(140);
    connect(m_coherence, &QSlider::valueChanged, this,
            [this](int step) { m_adapting.setCoherence(coherenceOf(step)); });
    m_coherenceText->setMinimumWidth(m_coherenceText->fontMetrics().horizontalAdvance("0.0099"));
    auto* label = new QLabel(tr("Transfer function:"), this);
    label->setBuddy(m_mode);
    connect(m_adapt.stop, &QToolButton::clicked, this,
            [this] { m_adapting.isStopped() ? m_adapting.goOn() : m_adapting.stop(); });
    return rowOf(
        {label, m_mode, Cell::gap(6), new QLabel(tr("Coherence"), this), m_coherence, m_coherenceText, Cell::rest()},
        4);
}

QLayout* PlayerPanel::keyRow() {
    auto* row = rowOf({}, 2);
    const std::pair<const char*, QString> keys[] = {{"tfKey", tr("◆ Key")},
                                                    {"targetKey", tr("○ Targets")},
                                                    {"previousKey", tr("‹ key")},
                                                    {"nextKey", tr("key ›")},
                                                    {"fromHere", tr("Start from this frame")}};
    for (qsizetype i = 0; i < m_adapting.keyActions().size(); ++i) {
        auto* const made = actionButton(*m_adapting.keyActions()[i], keys[i].first, keys[i].second, this);
        made->setAutoRaise(true);
        row->addWidget(made);
    }
    row->addStretch(1);
    return row;
}

void PlayerPanel::followAdapting() {
    const Session& session = m_services.store().session();
    const AdaptSettings& settings = *session.adapt;
    const bool open = m_player.hasSeries() && !m_services.isReadOnly();
    const bool adapts = settings.mode != AdaptSettings::Mode::Static;
    m_mode->setEnabled(open);
    m_mode->setCurrentIndex(static_cast<int>(settings.mode));
    m_coherence->setEnabled(open && adapts);
    const double coherence = settings.usedCoherence();
    {
        const QSignalBlocker quiet(m_coherence);
        if (coherenceOf(m_coherence->value()) != coherence) m_coherence->setValue(stepOf(coherence));
    }
    m_coherenceText->setText(coherenceText(coherence));
    const AdaptProgress progress = m_adapting.progress();
    const bool all = progress.done >= progress.all, smooth = progress.smooth >= progress.all;
    m_adapt.text->setVisible(adapts && open);
    m_adapt.text->setText(!all      ? tr("made for %L1 of %L2 frames").arg(progress.done).arg(progress.all)
                          : !smooth ? tr("smoothing over all frames")
                                    : tr("made for all frames"));
    for (QWidget* widget : std::initializer_list<QWidget*>{m_adapt.bar, m_adapt.stop})
        widget->setVisible(adapts && open && !(all && smooth));
    m_adapt.show(all ? m_adapting.smoothing() : static_cast<double>(progress.done) / progress.all,
                 !m_adapting.isStopped(),
                 m_adapting.isStopped() ? tr("Make the transfer functions of the other frames")
                                        : tr("Stop making transfer functions for other frames for now"));
    followMarks();
}

void PlayerPanel::showDock(bool shown) {
    QDockWidget* const dock = m_services.panels().dock("player");
    if (dock == nullptr || dock->isHidden() == !shown) return;
    dock->setVisible(shown);
    m_shownByItself = shown;
    auto* const window = qobject_cast<QMainWindow*>(dock->parentWidget());
    if (shown && window != nullptr && !dock->isFloating())
        window->resizeDocks({dock}, {minimumSizeHint().width() + 8}, Qt::Horizontal); // the curve has the rest
}

void PlayerPanel::follow(const Scene& before, const Scene& after) {
    const bool series = after.series && after.series->varies();
    if (before.volume != after.volume)
        m_strip->setSeries(series ? after.series : nullptr, series ? after.volume->range() : ValueRange{0, 1});
    if (before.volume != after.volume || before.session.frame != after.session.frame) followPlayer();
    if (!before.session.variables.isSame(after.session.variables) ||
        !before.session.targetKeys.isSame(after.session.targetKeys) || before.volume != after.volume ||
        !before.session.adapt.isSame(after.session.adapt))
        followAdapting();
    if (before.series != after.series && (series || m_shownByItself)) showDock(series);
}

void PlayerPanel::followPlayer() {
    const bool series = m_player.hasSeries();
    m_play->setIcon(signOf(m_player.isPlaying() ? Sign::Pause : Sign::Play));
    m_strip->setEnabled(series);
    m_speed->setEnabled(series);
    showNumber(*m_speed, m_player.speed());
    m_rate->setText(m_player.rateText());
    if (!series) return m_frame->setText({});
    m_frame->setText(tr("<b>%1</b> (%L2 of %L3)")
                         .arg(m_player.label(m_player.frame()).toHtmlEscaped())
                         .arg(m_player.frame() + 1)
                         .arg(m_player.frameCount()));
    m_strip->setFrame(m_player.frame(), m_player.awaited());
}

void PlayerPanel::followSurvey() {
    const int known = m_player.knownCount(), count = m_player.frameCount();
    const bool open = m_player.hasSeries() && known < count;
    for (QWidget* widget : std::initializer_list<QWidget*>{m_survey.text, m_survey.bar, m_survey.stop})
        widget->setVisible(open);
    m_survey.text->setText(tr("%L1 of %L2 frames known").arg(known).arg(count));
    m_survey.show(static_cast<double>(known) / std::max(1, count), m_player.isSurveying(),
                  m_player.isSurveying() ? tr("Read only the frames that are shown")
                                         : tr("Read all frames, so that the strip shows their histograms"));
    m_strip->refresh();
    followMarks();
}

void PlayerPanel::followMarks() {
    if (!m_player.hasSeries()) return;
    const Session& session = m_services.store().session();
    const TfTrack& track = session.variable().track;
    std::vector<FrameMark> marks(static_cast<std::size_t>(m_player.frameCount()));
    const bool keys = track.keys.size() > 1 || session.adapt->mode != AdaptSettings::Mode::Static;
    for (int f = 0; f < m_player.frameCount(); ++f) {
        FrameMark& mark = marks[static_cast<std::size_t>(f)];
        mark.tfKey = keys && track.keys.contains(f);
        mark.targetKey = session.targetKeys->contains(f);
        mark.adapted = session.adapt->mode != AdaptSettings::Mode::Static && track.adapted.contains(f);
        mark.stale = m_adapting.isStale(f);
        mark.held = m_player.isHeld(f);
        mark.problem = m_player.problemOf(f);
    }
    m_strip->setMarks(std::move(marks));
}

} // namespace

PanelInfo playerPanel() {
    return {.id = "player",
            .title = QObject::tr("Time"),
            .group = PanelGroup::Time,
            .area = Qt::BottomDockWidgetArea,
            .visible = false,
            .beside = "tf",
            .keys = QKeySequence("Ctrl+3"),
            .tip = QObject::tr("The frames of a series: play, step, key frames, transfer functions over time"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                services.actions().addGestures(
                    {{QObject::tr("Time"), QObject::tr("Drag over the frames"), QObject::tr("go to the frame")},
                     {QObject::tr("Time"), QObject::tr("Wheel, ← and →"), QObject::tr("one frame back, forward")},
                     {QObject::tr("Time"), QObject::tr("Page up, page down"), QObject::tr("ten frames")}});
                auto* panel = new PlayerPanel(services, controllers.player, controllers.adapting, parent);
                if (DockTitle* const title = DockTitle::of(parent)) panel->fill(title->controls());
                return panel;
            }};
}

} // namespace pellucid::gui
