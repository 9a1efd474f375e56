// A tour of the window in five steps: small cards that point at the real controls. The window can be used meanwhile.
#pragma once

#include <vector>

#include <QFrame>
#include <QPointer>

class QLabel;
class QMainWindow;
class QPushButton;

namespace pellucid::gui {

class Services;

/// Esc, "Leave tour" or the end takes it away, and gives the focus back. Right and left arrow, or the buttons, go on
/// and back. Those who hear the window are told each step.
class Tour : public QFrame {
    Q_OBJECT
public:
    /// Over `window`, from the first step on.
    Tour(QMainWindow& window, Services& services);
    ~Tour() override;

    /// Whether somebody has been through it or left it: the key "tourSeen" of the settings.
    static bool wasSeen();

    int step() const { return m_step; } ///< from 0
    static int stepCount();
    /// What the card points at, and the outline around it; null where the window has not got it.
    QWidget* target() const { return m_target; }
    void next(); ///< from the last step on it ends
    void back();
    void leave(); ///< it is deleted when the event loop turns

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;

private:
    void showStep(int step);
    void follow(QWidget* target);
    void place();
    void addKey(int key, void (Tour::*act)());

    QMainWindow& m_window;
    Services& m_services;
    int m_step = 0;
    QLabel *m_title, *m_text;
    QPushButton *m_leave, *m_back, *m_next;
    QWidget* m_mark; ///< the outline, a child of the window
    QPointer<QWidget> m_target, m_focusBefore;
    std::vector<QPointer<QWidget>> m_watched;
};

/// Starts it, or goes on with the one that is open.
void startTour(QMainWindow& window, Services& services);

} // namespace pellucid::gui
