// The panel of comparisons: what B is, how both are shown, how much they differ, and what their features come to.
#include <algorithm>

#include <QComboBox>
#include <QInputDialog>
#include <QMenu>
#include <QPushButton>

#include "controllers/controllers.h"
#include "panels/compare_bars.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/setting_rows.h"
#include "render/standard_view.h"
#include "tf/presets.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kMostOffered = 20; // of the history, that are offered

class ComparePanel : public QWidget {
public:
    ComparePanel(Services& services, ComparisonController& comparing, PlayerController& player, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }

private:
    void fillChoices(QMenu& menu);
    void addSteps(QMenu& menu);
    void askFrame();
    void addRows(QFormLayout& form);
    QPushButton* button(const QString& id, QAction* action, const QString& text);
    void follow();
    QString stateText() const;

    Services& m_services;
    ComparisonController& m_comparing;
    PlayerController& m_player;
    QLabel* m_name = wrappedLabel("compareName", this);
    QLabel* m_words = wrappedLabel("compareWords", this);
    QLabel* m_state = wrappedLabel("compareState", this);
    QProgressBar* m_progress = progressBar("compareProgress", this);
    QComboBox* m_figure = named(new QComboBox(this), "compareFigure", tr("What the bars tell of each feature"));
    CompareBars* m_bars = new CompareBars(this);
    SettingRows* m_rows = nullptr;
    QWidget* m_sameFrame = nullptr; ///< shown where there are frames
    QFormLayout* m_form = scrolledForm(this, 7);
    quint64 m_version = 0;
};

ComparePanel::ComparePanel(Services& services, ComparisonController& comparing, PlayerController& player,
                           QWidget* parent)
    : QWidget(parent), m_services(services), m_comparing(comparing), m_player(player) {
    setObjectName("comparePanel");
    makeFaint(*m_state);
    makeBold(*m_name);
    m_progress->setMaximumHeight(6);
    QFormLayout& form = *m_form;
    QToolButton* const choose = menuButton(tr("&Compare with"), this);
    named(choose, "compareChoose", tr("The state that stands beside the present one"));
    choose->setMenu(new QMenu(choose));
    connect(choose->menu(), &QMenu::aboutToShow, this, [this, choose] { fillChoices(*choose->menu()); });
    form.addRow(choose);
    form.addRow(m_name);
    addRows(form);
    form.addRow(m_words);
    form.addRow(m_state);
    form.addRow(m_progress);
    for (const ComparedFigure& figure : comparedFigures()) m_figure->addItem(nameOf(figure));
    connect(&terms(), &Terms::changed, this, [this] {
        for (int i = 0; i < m_figure->count(); ++i)
            m_figure->setItemText(i, nameOf(comparedFigures()[static_cast<std::size_t>(i)]));
    });
    form.addRow(tr("&Bars"), m_figure);
    form.addRow(m_bars);
    const CompareActions& actions = comparing.actions();
    form.addRow(
        rowOf({button("compareSwap", actions.swap, tr("S&wap")), button("compareUse", actions.use, tr("&Use B")),
               button("compareClear", actions.clear, tr("Clea&r"))}));
    form.addRow(tr("Save"), rowOf({button("compareSavePictures", actions.savePictures, tr("P&ictures…")),
                                   button("compareSaveDifference", actions.saveDifference, tr("&Difference…")),
                                   button("compareSaveFigures", actions.saveFigures, tr("F&igures…"))}));
    connect(m_figure, &QComboBox::currentIndexChanged, this,
            [this](int index) { m_bars->setFigure(static_cast<std::size_t>(std::max(0, index))); });
    connect(&comparing, &ComparisonController::changed, this, &ComparePanel::follow);
    connect(&comparing, &ComparisonController::sceneChanged, this, &ComparePanel::follow);
    follow();
}

void ComparePanel::addRows(QFormLayout& form) {
    m_rows = new SettingRows(m_services, form, settingPart<ComparisonView>(&Session::comparison));
    // It is no step of the history.
    const auto put = [this](const SessionStore::Change& change) {
        m_comparing.change([&](ComparisonView& view) {
            Session session = m_services.store().session();
            change(session);
            view = *session.comparison;
        });
    };
    m_rows->setCommit([put](const QString&, const QString&, const SessionStore::Change& change) { put(change); });
    m_rows->setPreview([put](const QString&, const SessionStore::Change& change) { put(change); }, [] { return true; });
    m_rows->add("mode", {.id = "compareMode"});
    m_rows->add("same_view", {.id = "compareSameView"});
    m_sameFrame = m_rows->add("same_frame", {.id = "compareSameFrame"});
    m_rows->add("same_look", {.id = "compareSameLook"});
    m_rows->add("strength", percentLook("compareStrength"));
    m_rows->follow();
}

/// A button for what a menu has, too.
QPushButton* ComparePanel::button(const QString& id, QAction* action, const QString& text) {
    auto* made = named(new QPushButton(text, this), id, action->toolTip());
    const auto follow = [=] { made->setEnabled(action->isEnabled()); };
    connect(made, &QPushButton::clicked, action, &QAction::trigger);
    connect(action, &QAction::changed, made, follow);
    follow();
    return made;
}

void ComparePanel::fillChoices(QMenu& menu) {
    menu.clear();
    menu.setToolTipsVisible(true);
    const CompareActions& actions = m_comparing.actions();
    menu.addAction(actions.pin);
    menu.addSeparator();
    QMenu* const presets = menu.addMenu(tr("&Preset"));
    for (const TfPreset& preset : tfPresets()) {
        const QString name =
            QString::fromStdString(preset.group.empty() ? preset.title : preset.group + ": " + preset.title);
        presets->addAction(name, this, [this, name, spec = "preset:" + QString::fromStdString(preset.name)] {
            m_comparing.compareWithTf(spec, name);
        });
    }
    menu.addActions({actions.tf, actions.session});
    menu.addSeparator();
    menu.addActions({actions.run, actions.refinement});
    addSteps(*menu.addMenu(tr("&Earlier step")));
    menu.addSeparator();
    QMenu* const views = menu.addMenu(tr("Another &view"));
    const bool open = m_services.store().hasVolume();
    for (const StandardView view : kStandardViews)
        if (open)
            views->addAction(name(view, m_services.scene().volume->geometry().worldAxes), this,
                             [this, view] { m_comparing.compareWithView(view); });
    menu.addAction(tr("Another &frame…"), this, [this] { askFrame(); })->setEnabled(m_player.frameCount() > 1);
    for (QMenu* part : {presets, views}) part->setEnabled(open);
}

void ComparePanel::addSteps(QMenu& menu) {
    const SessionStore& store = m_services.store();
    const int last = store.doneCount() - 1;
    for (int step = last; step >= 0 && step > last - kMostOffered; --step)
        menu.addAction(tr("Before: %1").arg(store.textOf(step)), this,
                       [this, step] { m_comparing.compareWithStep(step); });
    menu.setEnabled(last >= 0);
}

void ComparePanel::askFrame() {
    bool ok = false;
    const int frame = QInputDialog::getInt(this, tr("Compare with another frame"), tr("Frame, from 0"),
                                           m_player.frame(), 0, m_player.frameCount() - 1, 1, &ok);
    if (ok) m_comparing.compareWithFrame(frame);
}

QString ComparePanel::stateText() const {
    using State = ComparisonController::State;
    switch (m_comparing.state()) {
    case State::Off:
        return m_comparing.hasB() ? tr("B is kept, but not shown.")
                                  : tr("Keep the present state as B, or choose another one to stand beside it.");
    case State::Field:
        return tr("A field is drawn. Switch it off to compare pictures of the data.");
    case State::Computing:
        return m_comparing.sceneB() == nullptr ? tr("The frame of B is being read.")
                                               : tr("Both are being drawn and measured.");
    case State::Current: {
        const Comparison& c = *m_comparing.comparison();
        return tr("Of both pictures, %1 × %2 pixels").arg(c.imageA.width).arg(c.imageA.height);
    }
    case State::Failed:
        return QString::fromUtf8(m_comparing.failure()->what());
    }
    return {};
}

void ComparePanel::follow() {
    using State = ComparisonController::State;
    const State state = m_comparing.state();
    const Comparison* const comparison = m_comparing.comparison();
    m_name->setText(m_comparing.hasB() ? tr("B: %1").arg(QString::fromStdString(m_comparing.view().b->name))
                                       : QString());
    m_name->setVisible(m_comparing.hasB());
    m_form->setRowVisible(m_sameFrame, m_player.frameCount() > 1);
    m_words->setVisible(comparison != nullptr);
    m_words->setEnabled(state == State::Current);
    if (comparison != nullptr) {
        const PictureDifference& d = comparison->difference;
        m_words->setText(tr("SSIM %1\nΔE: mean %2, largest %3\n%4 % of the pixels above 2.3 (just noticed)")
                             .arg(d.ssim, 0, 'f', 4)
                             .arg(d.mean, 0, 'f', 2)
                             .arg(d.largest, 0, 'f', 1)
                             .arg(100 * d.noticed, 0, 'f', 1));
    }
    if (comparison == nullptr) {
        m_bars->setPairs({}, false);
    } else if (m_version != m_comparing.version()) {
        m_bars->setPairs(comparison->features, state == State::Current);
    }
    m_version = comparison == nullptr ? 0 : m_comparing.version();
    m_bars->setCurrent(state == State::Current);
    m_state->setText(stateText());
    m_progress->setVisible(state == State::Computing);
    m_progress->setValue(static_cast<int>(100 * m_comparing.progress()));
}

} // namespace

PanelInfo comparePanel() {
    return {.id = "compare",
            .title = QObject::tr("Compare"),
            .group = PanelGroup::Shares,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+Alt+C"),
            .tip = QObject::tr("The present state beside another one: pictures, their difference, figures"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                return new ComparePanel(services, controllers.comparing, controllers.player, parent);
            }};
}

} // namespace pellucid::gui
