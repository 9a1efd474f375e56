#include "window/main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QDialog>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QScreen>
#include <QStatusBar>
#include <QTextBrowser>

#include "controllers/controllers.h"
#include "dialogs/closing_buttons.h"
#include "dialogs/command_palette.h"
#include "dialogs/keys_dialog.h"
#include "dialogs/preferences_dialog.h"
#include "panels/panel.h"
#include "panels/probe_panel.h"
#include "services/recent_files.h"
#include "session/caption.h"
#include "view/annotation_layer.h"
#include "view/clip_layer.h"
#include "view/difference_layer.h"
#include "view/light_layer.h"
#include "view/region_layer.h"
#include "view/ruler_layer.h"
#include "view/saliency_layer.h"
#include "widgets/dock_title.h"
#include "widgets/layouts.h"
#include "widgets/named.h"
#include "widgets/scrolled.h"
#include "widgets/shown_vision.h"
#include "window/dock_space.h"
#include "window/notice_bar.h"
#include "window/room.h"
#include "window/status_line.h"
#include "window/tour.h"
#include "window/welcome_card.h"

namespace pellucid::gui {
namespace {

constexpr int kKeysWidth = 620;        // logical pixels
constexpr double kKeysOfScreen = 0.85; // of its height

/// What drags over the volume do, and all else below it: the rows in which `text` occurs.
QString tableOfKeys(const Actions& actions, const QString& text) {
    const QString row = QStringLiteral("<tr><td>%1&nbsp;&nbsp;</td><td>%2</td></tr>");
    QString rows;
    for (const MotionText& motion : motionTexts(mouseScheme()))
        if (motion.how.contains(text, Qt::CaseInsensitive) || motion.what.contains(text, Qt::CaseInsensitive))
            rows += row.arg(motion.how.toHtmlEscaped(), motion.what.toHtmlEscaped());
    const QString title = QObject::tr("The view of the volume, as Edit ▸ Preferences has it");
    if (!rows.isEmpty())
        rows = QStringLiteral("<table cellpadding=2><tr><td colspan=2><b>%1</b></td></tr>%2</table>").arg(title, rows);
    return rows + actions.keyTable(text);
}

/// All that mouse and keys do, as a table that can be searched: as high as the table where the screen has the room, and
/// scrolled where it has not.
void showKeys(const Actions& actions, QWidget* parent) {
    QDialog dialog(parent);
    dialog.setObjectName("keysBox");
    dialog.setWindowTitle(QObject::tr("Mouse and keys"));
    auto* find = named(new QLineEdit(&dialog), "keysFind", QObject::tr("Lists the rows that have these letters"));
    find->setAccessibleName(QObject::tr("Find a key or what it does"));
    find->setPlaceholderText(QObject::tr("Find a key or what it does"));
    find->setClearButtonEnabled(true);
    auto* table = named(new QTextBrowser(&dialog), "keysTable", QObject::tr("What the mouse and the keys do"));
    table->setAccessibleName(QObject::tr("Mouse and keys"));
    table->setHtml(tableOfKeys(actions, {}));
    QObject::connect(find, &QLineEdit::textChanged, table,
                     [table, &actions](const QString& text) { table->setHtml(tableOfKeys(actions, text)); });
    dialog.setLayout(columnOf({find, {table, 1}, closingButtons(dialog, QDialogButtonBox::Close)}));
    const QSize screen = dialog.screen()->availableSize();
    const QSize most(screen.width() * 9 / 10, static_cast<int>(kKeysOfScreen * screen.height()));
    dialog.resize(QSize(kKeysWidth, most.height()).boundedTo(most));
    dialog.exec();
}

} // namespace

MainWindow::MainWindow(ViewRenderer renderer, QWidget* parent)
    : QMainWindow(parent), m_services(std::make_unique<Services>(this)),
      m_controllers(std::make_unique<Controllers>(*m_services)),
      m_view(new VolumeView(m_services->store(), renderer, this, &m_controllers->fields)),
      m_views(new ViewGrid(*m_services, m_controllers->fields, m_controllers->rulers, *m_view, m_controllers->comparing,
                           this)),
      m_row(new QHBoxLayout), m_room(new Room(*this, *m_services, *m_row)) {
    setObjectName("mainWindow");
    setAcceptDrops(true);
    setDockNestingEnabled(true);
    auto* middle = new QWidget(this);
    m_row->addWidget(m_views, 1);
    middle->setLayout(inset(m_row, {}));
    new NoticeBar(m_services->notices(), middle);
    setCentralWidget(middle);

    connect(&m_services->results(), &Results::changed, m_view, [this] { describePicture(); });
    m_view->overlay().add(std::make_unique<SaliencyLayer>(m_controllers->pictureSaliency, m_view->overlay()));
    m_view->overlay().add(std::make_unique<DifferenceLayer>(m_controllers->comparing, m_view->overlay()));
    m_view->overlay().add(std::make_unique<SliceLayer>());
    addClipHandles(*m_services, *m_controllers->clipHandles, m_view->overlay());
    m_view->overlay().add(std::make_unique<LightLayer>(*m_services, m_view->overlay()));
    m_view->overlay().add(std::make_unique<RulerLayer>(m_controllers->rulers, m_services->store(), m_view->overlay()));
    addProbe(*m_services, m_controllers->probe, *m_view);
    m_view->overlay().add(std::make_unique<RegionLayer>(*m_services, m_controllers->refining, m_view->overlay()));
    m_room->addActions();
    addPanels();
    addHelpActions();
    m_services->actions().build(*this);
    m_controllers->opening.updateRecentFiles();
    setRecentView(*m_services, *m_view);
    Controllers& c = *m_controllers;
    m_status = new StatusLine(*m_services, {&c.opening, &c.saving, &c.figures, &c.films, &c.sharing, &c.studies},
                              *m_view, *statusBar());

    connect(m_view, &VolumeView::pictureShown, this, [this] {
        const PictureInfo& picture = m_view->picture();
        m_controllers->saving.setSeenSize({picture.width, picture.height});
        m_controllers->figures.setSeenSize({picture.width, picture.height});
        m_controllers->films.setSeenSize({picture.width, picture.height});
        m_controllers->refining.setViewSize({picture.width, picture.height});
        m_controllers->pictureSaliency.setPictureSize({picture.width, picture.height});
        m_controllers->comparing.setPictureSize({picture.width, picture.height});
        m_controllers->player.pictureShown(picture.volume);
        Q_EMIT settledChanged();
    });
    connect(m_views, &ViewGrid::slicesShown, this, &MainWindow::settledChanged);
    connect(m_view, &VolumeView::rendererFailed, this,
            [this](const Error& error) { m_services->notices().add({error.what()}); });
    connect(m_services.get(), &Services::idleChanged, this, &MainWindow::settledChanged);
    connect(&m_services->store(), &SessionStore::historyChanged, this, &MainWindow::updateTitle);
    connect(&m_controllers->saving, &SaveController::sessionPathChanged, this, &MainWindow::updateTitle);
    connect(m_view, &VolumeView::clicked, this, [this] { m_controllers->rulers.select(0); });
    connect(&m_controllers->rulers, &RulerController::placingChanged, this, [this] {
        if (m_controllers->rulers.placing()) m_view->setFocus(); // Esc is for it
    });
    connect(&m_controllers->views, &ViewSearchController::glimpsed, m_view, &VolumeView::lookFrom);
    updateTitle();
    resize(QSize(1280, 800).boundedTo(screen()->availableSize()));
}

MainWindow::~MainWindow() {
    // Widgets refer to the services, its jobs to nothing of theirs: so widgets go first.
    m_services->disconnect();
    m_services->panels().disconnect();
    delete takeCentralWidget();
    for (QDialog* dialog : findChildren<QDialog*>(QString(), Qt::FindDirectChildrenOnly)) delete dialog;
    for (QDockWidget* dock : findChildren<QDockWidget*>()) delete dock;
    for (StatusLine* line : statusBar()->findChildren<StatusLine*>()) delete line;
}

void MainWindow::addPanels() {
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    auto* const space = new DockSpace(*this);
    const std::vector<PanelInfo> panels = panelRegistry();
    for (const PanelInfo& panel : panels) {
        auto* dock = new QDockWidget(panel.title, this);
        dock->setObjectName(QString(panel.id) + "Dock");
        dock->setTitleBarWidget(new DockTitle(*dock));
        dock->setWidget(new DockScroll(panel.make(*m_services, *m_controllers, dock), panel.area));
        followShownVision(*dock->widget());
        addDockWidget(panel.area, dock);
        dock->setVisible(panel.visible);
        space->watch(*dock);
        if (panel.tabOf != nullptr) {
            auto* beside = m_services->panels().dock(panel.tabOf);
            tabifyDockWidget(beside, dock);
            beside->raise();
        }
        if (panel.beside != nullptr) splitDockWidget(m_services->panels().dock(panel.beside), dock, Qt::Horizontal);
        if (panel.size > 0)
            resizeDocks({dock}, {panel.size}, panel.area == Qt::BottomDockWidgetArea ? Qt::Vertical : Qt::Horizontal);
        m_services->panels().add(panel.id, *dock);
    }
    m_services->panels().dock("features")->raise();
    addPanelActions(panels);
    m_room->panelsAdded();
    connect(&m_services->panels(), &Panels::visibilityChanged, &m_services->actions(), &Actions::refresh);
}

void MainWindow::addPanelActions(const std::vector<PanelInfo>& panels) {
    const std::pair<PanelGroup, QString> groups[] = {{PanelGroup::Look, tr("Look")},
                                                     {PanelGroup::Shares, tr("Shares")},
                                                     {PanelGroup::Time, tr("Time")},
                                                     {PanelGroup::Files, tr("Files")}};
    ActionMenu menu(m_services->actions(), tr("&Panels"));
    for (const auto& [group, title] : groups) {
        menu.beginSection(title);
        for (const PanelInfo& panel : panels) {
            if (panel.group != group) continue;
            QDockWidget* const dock = m_services->panels().dock(panel.id);
            menu.addCheck(
                QString(panel.id) + "Action", panel.title, panel.keys.toString(), panel.tip,
                [dock] { return !dock->isHidden(); },
                [this, dock] { togglePanel(*dock, *static_cast<DockScroll*>(dock->widget())); });
        }
    }
}

void MainWindow::togglePanel(QDockWidget& dock, const DockScroll& content) {
    dock.setVisible(!isInFront(dock)); // what lies behind a tab is not put away unseen
    if (dock.isHidden()) return;
    dock.raise();
    // As high as it likes, where it would be much lower; as wide as it must be, if it can.
    const int wanted = content.sizeHint().height(), least = content.leastOfContent().width();
    if (content.height() < wanted * 2 / 3) resizeDocks({&dock}, {wanted}, Qt::Vertical);
    if (content.width() < least) resizeDocks({&dock}, {std::min(least, width() / 2)}, Qt::Horizontal);
    // A tab that has come back is in front only when the window has laid it out.
    later(this, [&dock] {
        if (!dock.isHidden()) dock.raise();
    });
}

void MainWindow::addHelpActions() {
    Actions& actions = m_services->actions();
    const QString volume = tr("Volume");
    actions.addGestures({{volume, tr("Double-click"), tr("fit")},
                         {volume, tr("Left drag of a clip handle; with Shift"), tr("cut; move the whole slab")},
                         {volume, tr("Esc"), tr("give up a drag")}});
    ActionMenu edit(actions, tr("&Edit"));
    edit.separate();
    edit.add("preferencesAction", tr("Pre&ferences…"), "Ctrl+Alt+,",
             tr("Theme, mouse, memory, threads and recent files of this machine"), [this] { showPreferences(); });
    actions.add(tr("&Help"), "keysAction", tr("&Mouse and keys"), "F1", {},
                [this] { showKeys(m_services->actions(), this); });
    actions.add(tr("&Help"), "paletteAction", tr("&Do something…"), "Ctrl+K",
                tr("Finds any command by a few letters of its name"),
                [this] { showCommandPalette(m_services->actions().rows(), this); });
    actions.add(tr("&Help"), "shortcutsAction", tr("&Keyboard shortcuts…"), {}, tr("Which keys do what, to be changed"),
                [this] {
                    Actions& all = m_services->actions();
                    KeysDialog(
                        all.rows(),
                        {[&all](const QAction& action) { return all.defaultKeys(action); },
                         [&all](QAction& action, const QList<QKeySequence>& keys) { all.setKeys(action, keys); }},
                        this)
                        .exec();
                });
    actions.add(tr("&Help"), "tourAction", tr("&Tour"), {},
                tr("The window in five steps, each beside the control that it is about; Esc leaves"), [this] {
                    m_room->setFocused(false); // panels are what it is about
                    startTour(*this, *m_services);
                });
    actions.add(tr("&Help"), "aboutAction", tr("&About Pellucid"), {}, {}, [this] {
        QMessageBox::about(this, tr("About Pellucid"),
                           tr("<b>Pellucid %1</b><br>The volume explorer that finds the transfer function for you.")
                               .arg(QApplication::applicationVersion()));
    });
    actions.add(tr("&File"), "quitAction", tr("&Quit"), "Ctrl+Q", {}, [] { QApplication::closeAllWindows(); });
}

void MainWindow::showPreferences() {
    OpenController& opening = m_controllers->opening;
    PreferencesDialog({[this, &opening] {
                           trimRecent();
                           opening.updateRecentFiles();
                           m_services->actions().refresh();
                           m_status->followMemory();
                       },
                       [&opening] {
                           clearRecent();
                           opening.updateRecentFiles();
                       },
                       [] { return !recentFiles().empty(); }},
                      this)
        .exec();
}

void MainWindow::watchMemory() { m_status->watchMemory(); }

void MainWindow::restoreLayout() { m_room->restore(); }

void MainWindow::welcome() {
    if (!WelcomeCard::hasSomething()) return;
    auto* card = new WelcomeCard(m_controllers->opening, centralWidget());
    m_row->insertWidget(0, card); // beside the picture, of which it hides nothing
    card->show();
    connect(card, &WelcomeCard::tourWanted, findChild<QAction*>("tourAction"), &QAction::trigger);
    // Another volume: it is no sample any more, and the first thing to try has been done.
    connect(&m_services->store(), &SessionStore::changed, card, [card](const Scene& before, const Scene& after) {
        if (before.series && before.series != after.series) card->dismiss();
    });
}

bool MainWindow::isSettled() const { return m_services->isIdle() && m_views->isComplete(); }

void MainWindow::describePicture() {
    const Results& results = m_services->results();
    if (!m_services->store().hasVolume() || !results.measures() || !results.measuresAreCurrent()) return;
    m_view->setAccessibleName(tr("Picture of the volume"));
    m_view->setAccessibleDescription(
        QString::fromStdString(altText(captionFacts(m_services->scene(), *results.measures()))));
}

void MainWindow::updateTitle() {
    SessionStore& store = m_services->store();
    if (!store.hasVolume()) return setWindowTitle(tr("Pellucid"));
    const QString title = QString::fromStdString(store.scene().volume->title),
                  file = m_controllers->saving.sessionPath();
    setWindowTitle(file.isEmpty() ? tr("%1[*] – Pellucid").arg(title)
                                  : tr("%1 – %2[*] – Pellucid").arg(title, QFileInfo(file).fileName()));
    setWindowModified(!store.isClean());
}

void MainWindow::changeEvent(QEvent* event) {
    QMainWindow::changeEvent(event);
    if (event->type() == QEvent::PaletteChange) m_services->actions().refresh(); // the theme, perhaps by another window
}

void MainWindow::showEvent(QShowEvent* event) {
    QMainWindow::showEvent(event);
    m_room->shown();
}

void MainWindow::closeEvent(QCloseEvent* event) {
    m_controllers->optimizing.cancel();
    if (!m_controllers->saving.maybeSave()) return event->ignore();
    keepRecentPicture(*m_services, m_controllers->saving.sessionPath());
    m_controllers->recovery.discard();
    m_controllers->opening.cancel();
    m_controllers->saving.cancel();
    m_room->save();
    event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    const QList<QUrl> urls = event->mimeData()->urls();
    if (!urls.isEmpty() && urls.front().isLocalFile()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    QStringList paths;
    for (const QUrl& url : event->mimeData()->urls())
        if (url.isLocalFile()) paths << url.toLocalFile();
    if (paths.isEmpty()) return;
    event->acceptProposedAction();
    // A dialog must not keep the program waiting that the file was dragged from.
    later(this, [this, paths] { m_controllers->opening.openPaths(paths); });
}

} // namespace pellucid::gui
