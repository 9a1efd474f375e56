// A card beside the picture of the first start: that this is a sample, and what to try.
#pragma once

#include <QFrame>

namespace pellucid::gui {

class WelcomeCard : public QFrame {
    Q_OBJECT
public:
    explicit WelcomeCard(QWidget* parent);

    /// Whether nobody has seen and dismissed it: the key "welcomeCardSeen" of the settings.
    static bool isWanted();
    /// Goes, for good.
    void dismiss();

Q_SIGNALS:
    void tourWanted(); ///< dismissed, too
};

} // namespace pellucid::gui
