// A card beside the sample of a start without a file: what to try at first, and the files that were open lately.
#pragma once

#include <QFrame>

class QToolButton;

namespace pellucid::gui {

class OpenController;
struct RecentFile;

class WelcomeCard : public QFrame {
    Q_OBJECT
public:
    /// What there is to say now; hasSomething() is true.
    WelcomeCard(OpenController& opening, QWidget* parent);

    /// Whether nobody has seen and dismissed what to try (the key "welcomeCardSeen" of the settings), or there are
    /// recent files that the preferences want here.
    static bool hasSomething();
    /// Goes; what to try does so for good.
    void dismiss();

Q_SIGNALS:
    void tourWanted(); ///< dismissed, too

private:
    QToolButton* tileOf(const RecentFile& file);

    OpenController& m_opening;
    bool m_tells; ///< what to try
};

} // namespace pellucid::gui
