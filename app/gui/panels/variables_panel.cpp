#include "panels/variables_panel.h"

#include <cmath>

#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "controllers/controllers.h"
#include "dialogs/series_files.h"
#include "panels/channels_box.h"
#include "panels/ground_box.h"
#include "panels/panel.h"
#include "panels/variable_words.h"
#include "services/services.h"
#include "session/scene_data.h"
#include "volume/file_contents.h"
#include "volume/procedural.h"
#include "widgets/named.h"
#include "widgets/number_text.h"
#include "widgets/scrolled.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

enum Column { kName, kDrives, kOrigin, kGrid, kRange, kColumns };

QString textOf(const std::string& text) { return QString::fromStdString(text); }

QString formulaOf(const Derivation& d) {
    switch (d.kind) {
    case Derivation::Kind::Gradient:
        return QObject::tr("|∇%1| of values scaled to 0 … 1, per d0").arg(textOf(d.of));
    case Derivation::Kind::Volatility:
        return QObject::tr("Standard deviation of %1, scaled to 0 … 1, over the latest %L2 frames")
            .arg(textOf(d.of))
            .arg(d.frames);
    case Derivation::Kind::Difference:
        return QObject::tr("%1 less its values in frame %L2, data units").arg(textOf(d.of)).arg(d.reference);
    }
    return {};
}

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
            info.sameGrid = onSameGrid(volume->geometry(), scene.volume->geometry());
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

} // namespace

VariablesPanel::VariablesPanel(Services& services, OpenController& opening, QWidget* parent)
    : QWidget(parent), m_services(services), m_opening(opening), m_list(new QTreeWidget(this)),
      m_add(new QToolButton(this)), m_addMenu(new QMenu(m_add)), m_remove(new QPushButton(tr("&Remove"), this)),
      m_wholeRange(new QPushButton(tr("All values"), this)), m_lo(new QLineEdit(this)), m_hi(new QLineEdit(this)),
      m_notice(new QLabel(this)), m_looking(lookAt, [this](const Scene&, std::map<std::string, VariableInfo>& infos) {
          m_infos = std::move(infos);
          follow();
      }) {
    setObjectName("variablesPanel");
    auto* content = new QWidget;
    auto* column = new QVBoxLayout(content);
    column->setContentsMargins(10, 8, 10, 8);
    column->setSpacing(8);
    column->addWidget(makeList());
    column->addWidget(m_channels = new ChannelsBox(services, opening, content));
    auto* line = new QFrame(content);
    line->setFrameShape(QFrame::HLine);
    column->addWidget(line);
    column->addWidget(new GroundBox(services, opening, content));
    column->addStretch(1);
    fillScrolled(this, content);

    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.series != after.series || !sameVariables(before.session, after.session)) lookAtVariables();
        if (before.volume != after.volume || !before.session.variables.isSame(after.session.variables) ||
            !before.session.hsb.isSame(after.session.hsb))
            follow();
    });
    connect(&services, &Services::readOnlyChanged, this, &VariablesPanel::follow);
    lookAtVariables();
    follow();
}

QWidget* VariablesPanel::makeList() {
    auto* box = new QWidget;
    auto* column = new QVBoxLayout(box);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(6);
    m_list->setObjectName("variablesList");
    m_list->setColumnCount(kColumns);
    m_list->setHeaderLabels({tr("Variable"), tr("Drives"), tr("From"), tr("Grid"), tr("Range")});
    m_list->setRootIsDecorated(false);
    m_list->setUniformRowHeights(true);
    m_list->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::DoubleClicked);
    m_list->setMinimumSize(120, 90);
    m_list->setMaximumHeight(150);
    m_list->setToolTip(tr("Double-click or F2: another name"));
    m_list->header()->setStretchLastSection(true);
    column->addWidget(m_list);
    m_notice->setObjectName("variablesNotice");
    m_notice->setWordWrap(true);
    m_notice->setTextFormat(Qt::PlainText);
    column->addWidget(m_notice);
    m_add->setObjectName("variableAdd");
    m_add->setText(tr("&Add"));
    m_add->setPopupMode(QToolButton::InstantPopup);
    m_add->setToolTip(tr("Another variable: of files, a sample, or made of one that is there"));
    m_addMenu->setObjectName("variableAddMenu");
    m_add->setMenu(m_addMenu);
    m_remove->setObjectName("variableRemove");
    m_lo->setObjectName("variableLo");
    m_hi->setObjectName("variableHi");
    for (QLineEdit* edit : {m_lo, m_hi}) {
        edit->setMinimumWidth(60);
        edit->setToolTip(tr("Values of the variable that are intensity 0 and 1, in its unit"));
        connect(edit, &QLineEdit::editingFinished, this, &VariablesPanel::editRange);
    }
    named(m_wholeRange, "variableWholeRange", tr("From the smallest to the largest value of all frames"));
    auto* row = new QHBoxLayout;
    row->addWidget(m_add);
    row->addWidget(m_remove);
    row->addStretch(1);
    column->addLayout(row);
    auto* range = new QHBoxLayout;
    range->addWidget(new QLabel(tr("Range"), box));
    range->addWidget(m_lo, 1);
    range->addWidget(m_hi, 1);
    range->addWidget(m_wholeRange);
    column->addLayout(range);

    connect(m_addMenu, &QMenu::aboutToShow, this, &VariablesPanel::fillAddMenu);
    connect(m_remove, &QPushButton::clicked, this, &VariablesPanel::remove);
    connect(m_list, &QTreeWidget::currentItemChanged, this, &VariablesPanel::showRange);
    connect(m_list, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item, int at) {
        if (!m_showing && at == kName) rename(item);
    });
    connect(m_wholeRange, &QPushButton::clicked, this, [this] {
        m_opening.editInJob(tr("All values of %1").arg(textOf(selected())), [name = selected()](Session& session) {
            session.variables.edit([&](std::vector<Variable>& all) {
                for (Variable& v : all)
                    if (v.name == name) v.window.reset();
            });
        });
    });
    return box;
}

QSize VariablesPanel::sizeHint() const { return findChild<QScrollArea*>()->widget()->sizeHint() + QSize(24, 4); }

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
    m_showing = true;
    m_list->clear();
    QStringList resampled;
    for (const Variable& v : *session.variables) {
        auto* item = new QTreeWidgetItem(m_list);
        const QString name = textOf(v.name);
        item->setFlags(item->flags() | Qt::ItemIsEditable);
        item->setText(kName, name);
        item->setData(kName, Qt::UserRole, name);
        item->setText(kOrigin, originText(v));
        item->setToolTip(kOrigin, v.derivation ? formulaOf(*v.derivation) : textOf(v.source.path));
        QStringList drives;
        const std::pair<Channel, QString> channels[] = {{Channel::Opacity, tr("opacity")},
                                                        {Channel::Saturation, tr("saturation")},
                                                        {Channel::Brightness, tr("brightness")},
                                                        {Channel::Hue, tr("hue")}};
        for (const auto& [channel, title] : channels)
            if (channelOf(session, channel) == v.name && (channel == Channel::Opacity || session.hsb->on))
                drives << title;
        item->setText(kDrives, drives.join(", "));
        if (const auto found = m_infos.find(v.name); found != m_infos.end()) {
            const VariableInfo& info = found->second;
            if (!info.problem.empty()) {
                item->setText(kGrid, tr("cannot be read"));
                item->setToolTip(kGrid, textOf(info.problem));
            } else {
                const QString grid = QStringLiteral("%1×%2×%3").arg(info.dims.x).arg(info.dims.y).arg(info.dims.z);
                item->setText(kGrid, info.frames > 1 ? tr("%1, %L2 frames").arg(grid).arg(info.frames) : grid);
                item->setText(kRange, rangeText(info.range));
                item->setToolTip(kRange, v.window          ? tr("Own range, in the unit of the variable")
                                         : info.wholeRange ? tr("All values, in the unit of the variable")
                                                           : tr("Values of this frame; other frames were not read"));
                if (!info.sameGrid) {
                    resampled << name;
                    item->setToolTip(kGrid, tr("Resampled onto the grid of %1").arg(textOf(session.variable().name)));
                }
            }
        }
        if (v.name == chosen) m_list->setCurrentItem(item);
    }
    if (m_list->currentItem() == nullptr && m_list->topLevelItemCount() > 0)
        m_list->setCurrentItem(m_list->topLevelItem(0));
    for (int c = 0; c < kColumns - 1; ++c) m_list->resizeColumnToContents(c);
    m_notice->setText(resampled.isEmpty() ? QString()
                                          : tr("Resampled onto the grid of %1 where colours come from it: %2.")
                                                .arg(textOf(session.variable().name), resampled.join(", ")));
    m_notice->setVisible(!resampled.isEmpty());
    m_showing = false;
    showRange();
}

void VariablesPanel::showRange() {
    if (m_showing) return;
    const Session& session = m_services.store().session();
    const std::string name = selected();
    const Variable* variable = session.variableNamed(name);
    const auto info = m_infos.find(name);
    const bool known = variable != nullptr && info != m_infos.end() && info->second.problem.empty();
    for (QWidget* widget : std::initializer_list<QWidget*>{m_lo, m_hi}) widget->setEnabled(known);
    m_wholeRange->setEnabled(known && variable->window);
    const ValueRange range = known ? variable->window.value_or(info->second.range) : ValueRange{0, 0};
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
    m_remove->setToolTip(why.isEmpty() ? tr("The variable goes; channels that it drives are constant then") : why);
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
        QMetaObject::invokeMethod(
            this,
            [this, error] {
                follow();
                m_services.showError(tr("Cannot rename the variable"), error);
            },
            Qt::QueuedConnection);
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
    if (m_showing || (!m_lo->isModified() && !m_hi->isModified())) return;
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
    m_opening.editInJob(tr("Range of %1").arg(textOf(selected())), [name = selected(), range](Session& s) {
        s.variables.edit([&](std::vector<Variable>& all) {
            for (Variable& v : all)
                if (v.name == name) v.window = range;
        });
    });
}

// ---- adding

void VariablesPanel::fillAddMenu() {
    m_addMenu->clear();
    const Session& session = m_services.store().session();
    if (session.isEmpty()) return;
    const auto action = [](QMenu& menu, const QString& text, const QString& name) {
        QAction* made = menu.addAction(text);
        made->setObjectName(name);
        return made;
    };
    connect(action(*m_addMenu, tr("&Files…"), "addFiles"), &QAction::triggered, this, [this] {
        if (const auto source = m_opening.askSource(tr("Add a variable"))) addFrom(*source);
    });
    connect(action(*m_addMenu, tr("&Series…"), "addSeries"), &QAction::triggered, this, [this] {
        if (const auto source = m_opening.askSeries()) addFrom(*source);
    });
    QMenu* samplesMenu = m_addMenu->addMenu(tr("Sa&mple"));
    for (const SampleInfo& sample : samples()) {
        QAction* entry = action(*samplesMenu, textOf(sample.name), "addSample_" + textOf(sample.name));
        entry->setToolTip(textOf(sample.description));
        connect(entry, &QAction::triggered, this, [this, name = sample.name] {
            VolumeSource source;
            source.path = "sample:" + name;
            const Variable& first = m_services.store().session().variable();
            if (!first.derivation && first.source.isSample()) { // of the same make
                source.sampleSize = first.source.sampleSize;
                source.seed = first.source.seed;
            }
            addFrom(source);
        });
    }
    for (const Variable& v : *session.variables) {
        const auto info = m_infos.find(v.name);
        if (info == m_infos.end() || info->second.arrays.size() < 2) continue;
        QMenu* menu = m_addMenu->addMenu(tr("&Array of %1").arg(titleOf(v.source)));
        for (const std::string& array : info->second.arrays) {
            VolumeSource source = v.source;
            source.array = array;
            connect(action(*menu, textOf(array), "addArray_" + textOf(array)), &QAction::triggered, this,
                    [this, source] { addFrom(source); });
        }
    }
    m_addMenu->addSeparator();
    const bool varies = m_services.scene().series && m_services.scene().series->varies();
    const std::tuple<Derivation::Kind, QString, const char*, QString> kinds[] = {
        {Derivation::Kind::Gradient, tr("&Gradient of"), "addGradient_", tr("gradient of %1")},
        {Derivation::Kind::Volatility, tr("&Volatility of"), "addVolatility_", tr("volatility of %1")},
        {Derivation::Kind::Difference, tr("&Difference to this frame of"), "addDifference_", tr("change of %1")}};
    for (const auto& [kind, text, name, title] : kinds) {
        QMenu* menu = m_addMenu->addMenu(text);
        menu->setEnabled(varies || kind == Derivation::Kind::Gradient);
        for (const Variable& v : *session.variables) {
            Variable made;
            made.name = title.arg(textOf(v.name)).toStdString();
            made.derivation = Derivation{kind, v.name, volatilityFrames(session).value_or(10), session.frame};
            connect(action(*menu, textOf(v.name), name + textOf(v.name)), &QAction::triggered, this,
                    [this, made, text = tr("Add %1").arg(textOf(made.name))] { add(made, text); });
        }
    }
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

PanelInfo variablesPanel() {
    return {.id = "variables",
            .title = QObject::tr("Variables"),
            .area = Qt::RightDockWidgetArea,
            .visible = false,
            .tabOf = "display",
            .keys = QKeySequence("Ctrl+Shift+V"),
            .tip = QObject::tr("Several variables, what each drives, and the ground"),
            .make = [](Services& services, Controllers& controllers, QWidget* parent) {
                const QString menu = QObject::tr("&View");
                SessionStore& store = services.store();
                auto* panel = new VariablesPanel(services, controllers.opening, parent);
                services.actions().add(
                    menu, "hsbAction", QObject::tr("Colours from &variables"), "Shift+S",
                    QObject::tr("Saturation, brightness and hue from variables, or colours of "
                                "the transfer function"),
                    [panel] { panel->channels().toggle(); }, [&services] { return services.isEditable(); },
                    {.checked = [&store] { return store.session().hsb->on; }, .separatorBefore = true});
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
                QObject::connect(&store, &SessionStore::changed, &services.actions(),
                                 [&services](const Scene& before, const Scene& after) {
                                     if (!before.session.hsb.isSame(after.session.hsb)) services.actions().refresh();
                                 });
                return panel;
            }};
}

} // namespace pellucid::gui
