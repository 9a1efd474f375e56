// A card over the picture of the first start: that this is a sample, and what to try.
#pragma once

#include <QFrame>

namespace pellucid::gui {

class WelcomeCard : public QFrame {
    Q_OBJECT
public:
    /// Lies over the lower left corner of `view`, whose parent it has: a view may change what it holds.
    explicit WelcomeCard(QWidget* view);

    /// Whether nobody has seen and dismissed it: the key "welcomeCardSeen" of the settings.
    static bool isWanted();
    /// Goes, for good.
    void dismiss();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void place();

    QWidget* m_view;
};

} // namespace pellucid::gui
