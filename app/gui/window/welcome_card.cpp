#include "window/welcome_card.h"

#include <QFileInfo>
#include <QPushButton>
#include <QSettings>
#include <QToolButton>

#include "controllers/open_controller.h"
#include "services/recent_files.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/preferences.h"
#include "window/tour.h"

namespace pellucid::gui {
namespace {

constexpr auto kSeenKey = "welcomeCardSeen";
constexpr int kWidth = 230; // logical pixels: what the picture beside it can do without
constexpr int kMargin = 14, kPadding = 10;
constexpr std::size_t kMostTiles = 5;
constexpr QSize kTilePicture{72, 54}; // logical pixels

bool wantsToTell() { return !QSettings().value(kSeenKey, false).toBool(); }

std::vector<RecentFile> tiles() {
    if (!keptPreferences().recentAtStart) return {};
    std::vector<RecentFile> files = recentFiles();
    if (files.size() > kMostTiles) files.resize(kMostTiles);
    return files;
}

} // namespace

WelcomeCard::WelcomeCard(OpenController& opening, QWidget* parent)
    : QFrame(parent), m_opening(opening), m_tells(wantsToTell()) {
    setObjectName("welcomeCard");
    setAutoFillBackground(true);
    setFrameShape(QFrame::StyledPanel);
    setFixedWidth(kWidth);
    QVBoxLayout* column = inset(columnOf({}), {kMargin, 12, kMargin, 12});
    if (m_tells) {
        QLabel* title = wrappedLabel("welcomeTitle", this);
        title->setText(tr("<b>This is a sample.</b> Three things to try:"));
        QLabel* things = wrappedLabel("welcomeThings", this);
        things->setText(
            tr("<ul style='margin-left: 14px; -qt-list-indent: 0;'>"
               "<li>Drop a file of your own onto the window, or press Ctrl+O.</li>"
               "<li>Click on a thing in the picture: what is it, and how much of it is seen?</li>"
               "<li>Drag the white handle on a feature's bar, then press Optimize: the feature gets that share of "
               "attention.</li></ul>"));
        add(*column, {title, things});
        if (!Tour::wasSeen()) {
            auto* tour = named(new QPushButton(tr("Take the tour"), this), "welcomeTour",
                               tr("The window in five steps, which you can leave; also in the menu Help"));
            connect(tour, &QPushButton::clicked, this, [this] {
                dismiss();
                Q_EMIT tourWanted();
            });
            add(*column, {tour});
        }
    }
    if (const std::vector<RecentFile> files = tiles(); !files.empty()) {
        QLabel* title = wrappedLabel("welcomeRecentTitle", this);
        title->setText(tr("<b>Recent files</b>"));
        add(*column, {title});
        for (const RecentFile& file : files) add(*column, {tileOf(file)});
    }
    auto* close = named(new QPushButton(m_tells ? tr("Got it") : tr("Close"), this), "welcomeClose",
                        m_tells ? tr("What to try will not be shown again")
                                : tr("Until the next start; Edit, Preferences can leave it out for good"));
    connect(close, &QPushButton::clicked, this, &WelcomeCard::dismiss);
    add(*column, {rowOf({Cell::rest(), close}), Cell::rest()});
    setLayout(column);
}

QToolButton* WelcomeCard::tileOf(const RecentFile& file) {
    auto* tile = named(toolButton({}, this), "welcomeRecent",
                       file.missing.isEmpty() ? file.path : tr("%1: %2").arg(file.path, file.missing));
    tile->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    tile->setIcon(recentIcon(file));
    tile->setIconSize(kTilePicture);
    tile->setAutoRaise(true);
    tile->setFixedWidth(kWidth - 2 * kMargin - 2 * frameWidth());
    tile->setFocusPolicy(Qt::StrongFocus);
    const int room = tile->width() - kTilePicture.width() - 2 * kPadding;
    const auto fitting = [&](const QString& text, Qt::TextElideMode mode) {
        return tile->fontMetrics().elidedText(text, mode, room).replace('&', "&&");
    };
    const QString below = file.missing.isEmpty() ? QFileInfo(file.path).path() : tr("missing");
    tile->setText(fitting(file.name, Qt::ElideMiddle) + "\n" + fitting(below, Qt::ElideLeft));
    tile->setAccessibleName(spokenText(file));
    tile->setEnabled(file.missing.isEmpty());
    connect(tile, &QToolButton::clicked, &m_opening, [&opening = m_opening, entry = file.entry] {
        opening.openPath(entry); // the card goes when it is open
    });
    return tile;
}

bool WelcomeCard::hasSomething() { return wantsToTell() || !tiles().empty(); }

void WelcomeCard::dismiss() {
    if (m_tells) QSettings().setValue(kSeenKey, true);
    hide();
    deleteLater();
}

} // namespace pellucid::gui
