#include "window/tour.h"

#include <algorithm>
#include <array>

#include <QAccessible>
#include <QApplication>
#include <QEvent>
#include <QLabel>
#include <QMainWindow>
#include <QMenuBar>
#include <QPainter>
#include <QPushButton>
#include <QScrollArea>
#include <QSettings>
#include <QShortcut>
#include <QToolBar>

#include "jobs/rest_timer.h"
#include "services/services.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr auto kSeenKey = "tourSeen";
constexpr int kCardWidth = 330, kGap = 14, kCardMargin = 8, kOutline = 3; // logical pixels

struct Step {
    const char *title, *text;
    const char* target; ///< object name of a widget, or of an action that stands in the tool bar
    const char* panel;  ///< opened before; null: none
};
constexpr std::array kSteps{
    Step{QT_TR_NOOP("Open your data"),
         QT_TR_NOOP("Drop a file onto the window, or press Ctrl+O. Pellucid looks at the values and finds "
                    "features, colours and a view to begin with."),
         "openAction", nullptr},
    Step{QT_TR_NOOP("Say what you want to see"),
         QT_TR_NOOP("Each bar shows how much attention a feature gets in this picture. Drag the white handle "
                    "to the share that it should have: that is its target."),
         "targetBars", "features"},
    Step{QT_TR_NOOP("Optimize"),
         QT_TR_NOOP("Pellucid changes the opacities until the bars meet their targets, as seen from this "
                    "side. Cancel goes back to where it began, and undo always works."),
         "optimizeButton", "features"},
    Step{QT_TR_NOOP("Look, and refine by hand"),
         QT_TR_NOOP("Drag to turn, use the wheel to zoom, click on a thing to learn what it is. The curve "
                    "below can be edited; the bars follow."),
         "volumeView", nullptr},
    Step{QT_TR_NOOP("Save and share"),
         QT_TR_NOOP("Ctrl+E saves the picture, Ctrl+S the session. The menu File also makes films, and a web "
                    "page that anybody can open. Ctrl+K finds any command by its name."),
         "saveImageAction", nullptr},
};

/// The outline around a control; clicks go through it.
class Mark : public QWidget {
public:
    explicit Mark(QWidget* parent) : QWidget(parent) {
        setObjectName("tourMark");
        setAttribute(Qt::WA_TransparentForMouseEvents);
        setAttribute(Qt::WA_NoSystemBackground);
        setFocusPolicy(Qt::NoFocus);
    }

protected:
    void paintEvent(QPaintEvent*) override {
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(QPen(theme::kAccent, kOutline));
        painter.drawRoundedRect(QRectF(rect()).adjusted(2, 2, -2, -2), 5, 5);
    }
};

QWidget* widgetNamed(QMainWindow& window, const char* name) {
    if (auto* const widget = window.findChild<QWidget*>(name)) return widget;
    auto* const action = window.findChild<QAction*>(name);
    if (action == nullptr) return nullptr;
    for (QToolBar* bar : window.findChildren<QToolBar*>())
        if (QWidget* const button = bar->widgetForAction(action); button != nullptr && button->isVisible())
            return button;
    return window.menuBar();
}

/// What of a widget can be seen, in the window's pixels.
QRect shownPartOf(const QWidget& widget, const QWidget& window) {
    QRect rect(widget.mapTo(&window, QPoint(0, 0)), widget.size());
    for (const QWidget* above = widget.parentWidget(); above != nullptr && above != &window;
         above = above->parentWidget())
        rect &= QRect(above->mapTo(&window, QPoint(0, 0)), above->size());
    return rect & window.rect();
}

/// Below a low target such as a button, else at its left, else where there is room; over the lower part of one that has
/// the room for it, as the picture.
QPoint placeBeside(const QRect& target, const QSize& card, const QRect& window) {
    const QRect room = window.adjusted(kCardMargin, kCardMargin, -kCardMargin, -kCardMargin);
    const auto within = [](int wanted, int lo, int hi) { return std::clamp(wanted, lo, std::max(lo, hi)); };
    const int x = within(target.center().x() - card.width() / 2, room.left(), room.right() - card.width());
    const int y = within(target.center().y() - card.height() / 2, room.top(), room.bottom() - card.height());
    if (target.width() > window.width() / 2 && target.height() > 2 * card.height())
        return {x, target.bottom() - kGap - card.height()};
    const std::array places{QPoint(x, target.bottom() + kGap), QPoint(target.left() - kGap - card.width(), y),
                            QPoint(x, target.top() - kGap - card.height()), QPoint(target.right() + kGap, y)};
    constexpr int kLow = 60; // logical pixels
    const std::array<std::size_t, 4> order =
        target.height() < kLow ? std::array<std::size_t, 4>{0, 2, 1, 3} : std::array<std::size_t, 4>{1, 0, 2, 3};
    for (const std::size_t i : order)
        if (room.contains(QRect(places[i], card))) return places[i];
    return {x, y};
}

} // namespace

Tour::Tour(QMainWindow& window, Services& services)
    : QFrame(&window), m_window(window), m_services(services), m_title(wrappedLabel("tourTitle", this)),
      m_text(wrappedLabel("tourText", this)),
      m_leave(named(new QPushButton(tr("Leave tour"), this), "tourLeave", tr("Help → Tour starts it again (Esc)"))),
      m_back(named(new QPushButton(tr("Back"), this), "tourBack", tr("The step before (left arrow)"))),
      m_next(named(new QPushButton(this), "tourNext", tr("The next step (right arrow)"))), m_mark(new Mark(&window)),
      m_focusBefore(QApplication::focusWidget()) {
    setObjectName("tour");
    setAutoFillBackground(true);
    setFixedWidth(kCardWidth);
    makeBold(*m_title);
    for (QPushButton* button : {m_leave, m_back, m_next}) button->setAutoDefault(false);
    connect(m_leave, &QPushButton::clicked, this, &Tour::leave);
    connect(m_back, &QPushButton::clicked, this, &Tour::back);
    connect(m_next, &QPushButton::clicked, this, &Tour::next);
    setLayout(inset(columnOf({m_title, m_text, rowOf({m_leave, Cell::rest(), m_back, m_next})}), {14, 12, 14, 12}));
    auto* const esc = new QShortcut(Qt::Key_Escape, &m_window);
    connect(this, &QObject::destroyed, esc, &QObject::deleteLater);
    connect(esc, &QShortcut::activated, this, &Tour::leave);
    addKey(Qt::Key_Right, &Tour::next);
    addKey(Qt::Key_Left, &Tour::back);
    m_window.installEventFilter(this);
    showStep(0);
}

Tour::~Tour() = default; // the window owns the outline, too, and may have deleted it already

bool Tour::wasSeen() { return QSettings().value(kSeenKey, false).toBool(); }
int Tour::stepCount() { return static_cast<int>(kSteps.size()); }

void Tour::addKey(int key, void (Tour::*act)()) {
    auto* const shortcut = new QShortcut(key, this);
    shortcut->setContext(Qt::WidgetWithChildrenShortcut);
    connect(shortcut, &QShortcut::activated, this, act);
}

void Tour::next() { m_step + 1 < stepCount() ? showStep(m_step + 1) : leave(); }
void Tour::back() {
    if (m_step > 0) showStep(m_step - 1);
}

void Tour::leave() {
    QSettings().setValue(kSeenKey, true);
    hide();
    m_mark->hide();
    m_mark->deleteLater();
    QWidget* const focus = m_focusBefore ? m_focusBefore.data() : m_window.findChild<QWidget*>("volumeView");
    if (focus != nullptr) focus->setFocus();
    deleteLater();
}

void Tour::showStep(int step) {
    m_step = step;
    const Step& s = kSteps[static_cast<std::size_t>(step)];
    if (s.panel != nullptr) m_services.panels().show(s.panel);
    m_title->setText(tr("%1 of %2: %3").arg(step + 1).arg(stepCount()).arg(tr(s.title)));
    m_text->setText(tr(s.text));
    m_back->setEnabled(step > 0);
    m_next->setText(step + 1 < stepCount() ? tr("Next") : tr("Done"));
    setAccessibleName(tr("Tour, step %1").arg(m_title->text()));
    setAccessibleDescription(m_text->text());
    m_next->setAccessibleName(m_next->text());
    m_next->setAccessibleDescription(m_title->text() + ". " + m_text->text()); // it has the focus, and is read out
    follow(widgetNamed(m_window, s.target));
    QFrame::show();
    m_next->setFocus();
    QAccessibleEvent said(this, QAccessible::Alert);
    QAccessible::updateAccessibility(&said);
    place();
    later(this, [this] { place(); }); // a panel that has just been opened gets its place then
}

/// What moves the target moves the card.
void Tour::follow(QWidget* target) {
    for (const QPointer<QWidget>& widget : m_watched)
        if (widget) widget->removeEventFilter(this);
    m_watched.clear();
    m_target = target;
    for (QWidget* widget = target; widget != nullptr && widget != &m_window; widget = widget->parentWidget()) {
        widget->installEventFilter(this);
        m_watched.emplace_back(widget);
    }
    for (QWidget* widget = target; widget != nullptr && widget != &m_window; widget = widget->parentWidget())
        if (auto* const area = qobject_cast<QScrollArea*>(widget)) area->ensureWidgetVisible(target, 0, 0);
}

bool Tour::eventFilter(QObject* watched, QEvent* event) {
    switch (event->type()) {
    case QEvent::Move:
    case QEvent::Resize:
    case QEvent::Show:
    case QEvent::Hide:
        later(this, [this] { place(); });
        break;
    default:
        break;
    }
    return QFrame::eventFilter(watched, event);
}

void Tour::place() {
    const int height = layout()->hasHeightForWidth() ? layout()->totalHeightForWidth(kCardWidth) : sizeHint().height();
    resize(kCardWidth, height);
    const bool isSeen = m_target && m_target->isVisible();
    const QRect target = isSeen ? shownPartOf(*m_target, m_window) : QRect(m_window.rect().center(), QSize(1, 1));
    m_mark->setGeometry(target.adjusted(-kOutline, -kOutline, kOutline, kOutline) & m_window.rect());
    m_mark->setVisible(isSeen && isVisible() && !target.isEmpty());
    move(placeBeside(target, size(), m_window.rect()));
    m_mark->raise();
    raise();
}

void Tour::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setPen(QPen(theme::kAccent, 1));
    painter.setBrush(theme::kRaised);
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

void startTour(QMainWindow& window, Services& services) {
    if (auto* const open = window.findChild<Tour*>("tour"); open != nullptr && open->isVisible()) {
        open->activateWindow();
        return open->findChild<QPushButton*>("tourNext")->setFocus();
    }
    new Tour(window, services); // the window owns it
}

} // namespace pellucid::gui
