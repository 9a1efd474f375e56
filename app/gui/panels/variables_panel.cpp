// The variables of a session: what they are, what they drive, and the ground under them.
#include <algorithm>
#include <cmath>
#include <map>

#include <QHeaderView>
#include <QLineEdit>
#include <QLocale>
#include <QMenu>
#include <QPushButton>
#include <QTreeWidget>

#include "controllers/controllers.h"
#include "dialogs/series_files.h"
#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "panels/channels_box.h"
#include "panels/ground_box.h"
#include "panels/panel.h"
#include "panels/panel_parts.h"
#include "panels/variable_words.h"
#include "session/scene_data.h"
#include "session/variable_edits.h"
#include "volume/file_contents.h"
#include "volume/orientation.h"
#include "volume/procedural.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kWidest = 90; ///< pixels, of names and of what they drive, until people drag the columns

enum Column { kName, kDrives, kOrigin, kGrid, kRange, kColumns };

QString textOf(const std::string& text) { return QString::fromStdString(text); }

QString formulaOf(const Session& session, const Derivation& d) {
    switch (d.kind) {
    case Derivation::Kind::Gradient:
        return QObject::tr("|∇%1| of values scaled to 0 … 1, per d0").arg(textOf(d.of));
    case Derivation::Kind::Volatility:
        if (session.measure->profile == Profile::Published)
            return QObject::tr("Published: sample standard deviation of %1, each frame scaled to 0 … 1, over the "
                               "latest %L2 frames, stretched to 0 … 1")
                .arg(textOf(d.of))
                .arg(d.frames);
        return QObject::tr("Standard deviation of %1, scaled to 0 … 1, over the latest %L2 frames")
            .arg(textOf(d.of))
            .arg(d.frames);
    case Derivation::Kind::Difference:
        return QObject::tr("%1 less its values in frame %L2, data units").arg(textOf(d.of)).arg(d.reference);
    }
    return {};
}

/// What is known of a variable once its present frame has been read.
struct VariableInfo {
    Int3 dims{0, 0, 0};
    int frames = 1;
    ValueRange range;                ///< data units
    bool wholeRange = false;         ///< of all frames, not of the present one alone
    bool sameGrid = true;            ///< as the first variable
    std::vector<std::string> arrays; ///< of its file, where that has several
    std::string problem;             ///< why it cannot be read; empty: it can
};

/// Each variable as far as it can be read.
std::map<std::string, VariableInfo> lookAt(const Scene& scene, const JobControl& job) {
    std::map<std::string, VariableInfo> infos;
    Scene copy = scene; // the finder adds to it
    SeriesFinder finder(copy, scene, {}, job);
    for (const Variable& variable : *scene.session.variables) {
        job.throwIfStopped();
        VariableInfo info;
        try {
            const auto series = finder.find(variable.name);
            const int frame = series->nearest(scene.session.frame);
            const auto volume = series->load(frame, {job.stop, {}});
            info.frames = series->size();
            const VolumeSource& source = series->listing().frames[static_cast<std::size_t>(frame)].source;
            if (!variable.derivation && !source.isSample() && !source.raw) info.arrays = contentsOf(source, job).arrays;
            info.dims = volume->dims();
            const Geometry& grid = scene.volume->geometry();
            info.sameGrid = onSameGrid(inUnit(volume->geometry(), unitOf(grid)), grid);
            info.wholeRange =
                variable.window || !series->varies() || series->listing().declaredRange || series->isSurveyed();
            info.range = variable.window   ? *variable.window
                         : info.wholeRange ? series->range({job.stop, {}})
                                           : volume->dataRange();
        } catch (const Error& error) {
            info.problem = error.what();
        }
        infos[variable.name] = info;
    }
    return infos;
}

/// Whether what is known of variables is known anew.
bool sameVariables(const Session& a, const Session& b) {
    return std::equal(a.variables->begin(), a.variables->end(), b.variables->begin(), b.variables->end(),
                      [](const Variable& v, const Variable& w) {
                          return v.name == w.name && sameOrigin(v, w) && v.window == w.window;
                      });
}

class VariablesPanel : public QWidget {
public:
    VariablesPanel(Services& services, OpenController& opening, QWidget* parent);

    QSize sizeHint() const override { return sizeWithoutScrolling(*this); }
    ChannelsBox& channels() { return *m_channels; }

private:
    void makeList();
    void fillAddMenu();
    std::string selected() const; ///< name of the variable in the list; empty: none
    QTreeWidgetItem* addToList(const Variable& variable);
    const VariableInfo* infoOf(const std::string& name) const; ///< null: it has not been read, or cannot be
    void follow();
    void lookAtVariables();
    void showRange();
    void add(const Variable& variable, const QString& text);
    void addFrom(const VolumeSource& source);
    void addSample(const std::string& name);
    void rename(QTreeWidgetItem* item);
    void remove();
    void editRange();
    void setWindow(const QString& text, const std::optional<ValueRange>& window); ///< empty: all values

    Services& m_services;
    OpenController& m_opening;
    QTreeWidget* m_list = named(new QTreeWidget(this), "variablesList", tr("Double-click or F2: another name"));
    ChannelsBox* m_channels = nullptr;
    QToolButton* m_add = named(menuButton(tr("&Add"), this), "variableAdd",
                               tr("Another variable: from files, a sample, or made of one that is there"));
    QPushButton* m_remove = named(new QPushButton(tr("&Remove"), this), "variableRemove");
    QPushButton* m_wholeRange = named(new QPushButton(tr("All values"), this), "variableWholeRange",
                                      tr("From the smallest to the largest value of all frames"));
    QLineEdit* m_lo =
        named(new QLineEdit(this), "variableLo", tr("The value that becomes intensity 0, in the unit of the variable"));
    QLineEdit* m_hi =
        named(new QLineEdit(this), "variableHi", tr("The value that becomes intensity 1, in the unit of the variable"));
    QLabel* m_notice = wrappedLabel("variablesNotice", this);
    std::map<std::string, VariableInfo> m_infos;
    Job<Scene, std::map<std::string, VariableInfo>> m_looking;
};

VariablesPanel::VariablesPanel(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening),
      m_looking(lookAt, [this](const Scene&, std::map<std::string, VariableInfo>& infos) {
          m_infos = std::move(infos);
          follow();
      }) {
    setObjectName("variablesPanel");
    m_notice->setTextFormat(Qt::PlainText);
    m_add->menu()->setObjectName("variableAddMenu");
    for (QLineEdit* edit : {m_lo, m_hi}) {
        edit->setMinimumWidth(60);
        connect(edit, &QLineEdit::editingFinished, this, &VariablesPanel::editRange);
    }
    makeList();
    auto* line = new QFrame;
    line->setFrameShape(QFrame::HLine);
    QLayout* const list = columnOf({m_list, m_notice, rowOf({m_add, m_remove, Cell::rest()}),
                                    rowOf({new QLabel(tr("Range")), {m_lo, 1}, {m_hi, 1}, m_wholeRange})},
                                   6);
    m_channels = new ChannelsBox(services, opening, this);
    fillScrolled(this, columnOf({list, m_channels, line, makeGroundBox(services, opening), Cell::rest()}, 8));

    connect(m_add->menu(), &QMenu::aboutToShow, this, &VariablesPanel::fillAddMenu);
    connect(m_remove, &QPushButton::clicked, this, &VariablesPanel::remove);
    connect(m_wholeRange, &QPushButton::clicked, this,
            [this] { setWindow(tr("All values of %1").arg(textOf(selected())), {}); });
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.series != after.series || !sameVariables(before.session, after.session)) lookAtVariables();
    });
    lookAtVariables();
    followParts(
        services, this, [this] { follow(); }, &Session::variables, &Session::hsb, &Session::measure);
}

void VariablesPanel::makeList() {
    m_list->setColumnCount(kColumns);
    m_list->setHeaderLabels({tr("Variable"), tr("Drives"), tr("From"), tr("Grid"), tr("Range")});
    elideInTheMiddle(*m_list);
    m_list->setRootIsDecorated(false);
    m_list->setUniformRowHeights(true);
    m_list->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::DoubleClicked);
    m_list->setMinimumSize(120, 90);
    m_list->setMaximumHeight(150);
    m_list->header()->setStretchLastSection(true);
    m_list->header()->moveSection(kGrid, kOrigin); // in sight: from where comes after it, and the range is below, too
    connect(m_list, &QTreeWidget::currentItemChanged, this, &VariablesPanel::showRange);
    connect(m_list, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item, int at) {
        if (at == kName) rename(item);
    });
}

std::string VariablesPanel::selected() const {
    const QTreeWidgetItem* item = m_list->currentItem();
    return item == nullptr ? "" : item->data(kName, Qt::UserRole).toString().toStdString();
}

// ---- the list

void VariablesPanel::lookAtVariables() {
    if (m_services.store().hasVolume()) m_looking.start(m_services.scene());
}

void VariablesPanel::follow() {
    setEnabled(m_services.isEditable());
    const Session& session = m_services.store().session();
    const std::string chosen = selected();
    {
        const QSignalBlocker quiet(m_list); // it shows, and edits nothing
        m_list->clear();
        for (const Variable& v : *session.variables) {
            QTreeWidgetItem* const item = addToList(v);
            if (v.name == chosen) m_list->setCurrentItem(item);
        }
        if (m_list->currentItem() == nullptr) m_list->setCurrentItem(m_list->topLevelItem(0));
        for (int c = 0; c < kColumns - 1; ++c) m_list->resizeColumnToContents(c);
        for (const int c : {kName, kDrives}) m_list->setColumnWidth(c, std::min(m_list->columnWidth(c), kWidest));
    }
    QStringList resampled;
    for (const Variable& v : *session.variables)
        if (const VariableInfo* info = infoOf(v.name); info != nullptr && !info->sameGrid) resampled << textOf(v.name);
    m_notice->setText(resampled.isEmpty() ? QString()
                                          : tr("Resampled onto the grid of %1 where colours come from it: %2.")
                                                .arg(textOf(session.variable().name), resampled.join(", ")));
    m_notice->setVisible(!resampled.isEmpty());
    showRange();
}

QTreeWidgetItem* VariablesPanel::addToList(const Variable& v) {
    const Session& session = m_services.store().session();
    auto* item = new QTreeWidgetItem(m_list);
    const QString name = textOf(v.name);
    item->setFlags(item->flags() | Qt::ItemIsEditable);
    item->setText(kName, name);
    item->setData(kName, Qt::UserRole, name);
    item->setText(kOrigin, originText(v));
    item->setToolTip(kOrigin, v.derivation ? formulaOf(session, *v.derivation) : textOf(v.source.path));
    QStringList drives;
    const std::pair<Channel, QString> channels[] = {{Channel::Opacity, tr("opacity")},
                                                    {Channel::Saturation, tr("saturation")},
                                                    {Channel::Brightness, tr("brightness")},
                                                    {Channel::Hue, tr("hue")}};
    for (const auto& [channel, title] : channels)
        if (channelOf(session, channel) == v.name && (channel == Channel::Opacity || session.hsb->on)) drives << title;
    item->setText(kDrives, drives.join(", "));
    if (const auto found = m_infos.find(v.name); found != m_infos.end() && !found->second.problem.empty()) {
        item->setText(kGrid, tr("cannot be read"));
        item->setToolTip(kGrid, textOf(found->second.problem));
    }
    const VariableInfo* const info = infoOf(v.name);
    if (info == nullptr) return item;
    const QString grid = QStringLiteral("%1×%2×%3").arg(info->dims.x).arg(info->dims.y).arg(info->dims.z);
    item->setText(kGrid, grid);
    item->setText(kRange, rangeText(info->range));
    item->setToolTip(kRange, v.window           ? tr("Own range, in the unit of the variable")
                             : info->wholeRange ? tr("All values, in the unit of the variable")
                                                : tr("Values of this frame; other frames were not read"));
    QStringList more;
    if (info->frames > 1) more << tr("%L1 frames").arg(info->frames);
    if (!info->sameGrid) more << tr("Resampled onto the grid of %1").arg(textOf(session.variable().name));
    item->setToolTip(kGrid, more.join('\n'));
    return item;
}

const VariableInfo* VariablesPanel::infoOf(const std::string& name) const {
    const auto found = m_infos.find(name);
    return found == m_infos.end() || !found->second.problem.empty() ? nullptr : &found->second;
}

void VariablesPanel::showRange() {
    const Session& session = m_services.store().session();
    const std::string name = selected();
    const Variable* variable = session.variableNamed(name);
    const VariableInfo* const info = infoOf(name);
    const bool known = variable != nullptr && info != nullptr;
    for (QWidget* widget : std::initializer_list<QWidget*>{m_lo, m_hi}) widget->setEnabled(known);
    m_wholeRange->setEnabled(known && variable->window);
    const ValueRange range = known ? variable->window.value_or(info->range) : ValueRange{0, 0};
    if (!m_lo->isModified()) m_lo->setText(known ? QLocale::c().toString(range.lo, 'g', 6) : QString());
    if (!m_hi->isModified()) m_hi->setText(known ? QLocale::c().toString(range.hi, 'g', 6) : QString());
    QString why;
    if (variable != nullptr) {
        Session without = session;
        try {
            removeVariable(without, name);
        } catch (const UsageError& error) {
            why = QString::fromUtf8(error.what());
        }
    }
    m_remove->setEnabled(variable != nullptr && why.isEmpty());
    m_remove->setToolTip(why.isEmpty() ? tr("Remove the variable; channels that it drives become constant") : why);
}

void VariablesPanel::rename(QTreeWidgetItem* item) {
    const std::string from = item->data(kName, Qt::UserRole).toString().toStdString();
    const std::string to = item->text(kName).trimmed().toStdString();
    if (from == to) return;
    Session renamed = m_services.store().session();
    try {
        renameVariable(renamed, from, to);
    } catch (const Error& error) {
        // The editor of the list is still open.
        later(this, [this, error] {
            follow();
            m_services.showError(tr("Cannot rename the variable"), error);
        });
        return;
    }
    m_opening.editInJob(tr("Rename %1").arg(textOf(from)), [from, to](Session& session) {
        if (session.variableNamed(from) != nullptr && session.variableNamed(to) == nullptr)
            renameVariable(session, from, to);
    });
}

void VariablesPanel::remove() {
    m_opening.editInJob(tr("Remove %1").arg(textOf(selected())), [name = selected()](Session& session) {
        if (session.variableNamed(name) != nullptr && session.variables->size() > 1 && madeOf(session, name).empty())
            removeVariable(session, name);
    });
}

void VariablesPanel::editRange() {
    if (!m_lo->isModified() && !m_hi->isModified()) return;
    bool isLo = false, isHi = false;
    const ValueRange range{QLocale::c().toDouble(m_lo->text().trimmed(), &isLo),
                           QLocale::c().toDouble(m_hi->text().trimmed(), &isHi)};
    // A window has two different ends: who has typed the one has not come to the other yet.
    if (isLo && isHi && !(range.lo < range.hi) && focusWidget() != nullptr &&
        (focusWidget() == m_lo || focusWidget() == m_hi) && (m_lo->isModified() != m_hi->isModified()))
        return;
    m_lo->setModified(false);
    m_hi->setModified(false);
    if (!isLo || !isHi || !(range.lo < range.hi) || !std::isfinite(range.hi - range.lo)) return showRange();
    setWindow(tr("Range of %1").arg(textOf(selected())), range);
}

void VariablesPanel::setWindow(const QString& text, const std::optional<ValueRange>& window) {
    m_opening.editInJob(text, changing(&Session::variables, [name = selected(), window](std::vector<Variable>& all) {
                            for (Variable& v : all)
                                if (v.name == name) v.window = window;
                        }));
}

// ---- adding

void VariablesPanel::fillAddMenu() {
    QMenu& menu = *m_add->menu();
    menu.clear();
    const Session& session = m_services.store().session();
    if (session.isEmpty()) return;
    const auto action = [this](QMenu& in, const QString& text, const QString& name, auto does) {
        QAction* const made = in.addAction(text, this, does);
        made->setObjectName(name);
        return made;
    };
    action(menu, tr("&Files…"), "addFiles", [this] {
        if (const auto source = m_opening.askSource(tr("Add a variable"))) addFrom(*source);
    });
    action(menu, tr("&Series…"), "addSeries", [this] {
        if (const auto source = m_opening.askSeries()) addFrom(*source);
    });
    QMenu& samplesMenu = *menu.addMenu(tr("Sa&mple"));
    for (const SampleInfo& sample : samples())
        action(samplesMenu, textOf(sample.name), "addSample_" + textOf(sample.name), [this, name = sample.name] {
            addSample(name);
        })->setToolTip(textOf(sample.description));
    for (const Variable& v : *session.variables) {
        const auto info = m_infos.find(v.name);
        if (info == m_infos.end() || info->second.arrays.size() < 2) continue;
        QMenu& arrays = *menu.addMenu(tr("&Array of %1").arg(titleOf(v.source)));
        for (const std::string& array : info->second.arrays) {
            VolumeSource source = v.source;
            source.array = array;
            action(arrays, textOf(array), "addArray_" + textOf(array), [this, source] { addFrom(source); });
        }
    }
    menu.addSeparator();
    const bool varies = m_services.scene().series && m_services.scene().series->varies();
    const std::tuple<Derivation::Kind, QString, const char*, QString> kinds[] = {
        {Derivation::Kind::Gradient, tr("&Gradient of"), "addGradient_", tr("gradient of %1")},
        {Derivation::Kind::Volatility, tr("&Volatility of"), "addVolatility_", tr("volatility of %1")},
        {Derivation::Kind::Difference, tr("&Difference to this frame of"), "addDifference_", tr("change of %1")}};
    for (const auto& [kind, text, name, title] : kinds) {
        QMenu& derived = *menu.addMenu(text);
        derived.setEnabled(varies || kind == Derivation::Kind::Gradient);
        for (const Variable& v : *session.variables) {
            Variable made;
            made.name = title.arg(textOf(v.name)).toStdString();
            made.derivation = Derivation{kind, v.name, volatilityFrames(session).value_or(10), session.frame};
            action(derived, textOf(v.name), name + textOf(v.name),
                   [this, made] { add(made, tr("Add %1").arg(textOf(made.name))); });
        }
    }
}

void VariablesPanel::addSample(const std::string& name) {
    VolumeSource source;
    source.path = "sample:" + name;
    const Variable& first = m_services.store().session().variable();
    if (!first.derivation && first.source.isSample()) { // of the same make
        source.sampleSize = first.source.sampleSize;
        source.seed = first.source.seed;
    }
    addFrom(source);
}

void VariablesPanel::addFrom(const VolumeSource& source) {
    Variable variable;
    variable.name = nameOfSource(source);
    variable.source = source;
    add(variable, tr("Add variable %1").arg(titleOf(source)));
}

void VariablesPanel::add(const Variable& variable, const QString& text) {
    m_opening.editInJob(text, [variable](Session& session) { addVariable(session, variable); });
}

} // namespace

PanelInfo variablesPanel() {
    return {.id = "variables",
            .title = QObject::tr("Variables"),
            .group = PanelGroup::Files,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+Shift+V"),
            .tip = QObject::tr("Several variables, what each drives, and the ground"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                const QString menu = QObject::tr("&View") + "/" + QObject::tr("Varia&bles");
                SessionStore& store = services.store();
                auto* panel = new VariablesPanel(services, controllers.opening, parent);
                services.actions().add(
                    menu, "hsbAction", QObject::tr("Colours from &variables"), "Shift+S",
                    QObject::tr("Saturation, brightness and hue from variables, or colours of "
                                "the transfer function"),
                    [panel] { panel->channels().toggle(); }, [&services] { return services.isEditable(); },
                    {.checked = [&store] { return store.session().hsb->on; }});
                services.actions().add(
                    menu, "swapVariablesAction", QObject::tr("S&wap opacity and brightness"), {},
                    QObject::tr("The variable of brightness drives opacity, and the other way round"),
                    [&opening = controllers.opening] {
                        opening.editInJob(QObject::tr("Swap variables"),
                                          [](Session& s) { swapOpacityAndBrightness(s); });
                    },
                    [&services] {
                        const Session& s = services.store().session();
                        return !s.isEmpty() && !services.isReadOnly() && !s.hsb->brightness.empty() &&
                               s.hsb->brightness != s.variable().name;
                    });
                return panel;
            }};
}

} // namespace pellucid::gui
