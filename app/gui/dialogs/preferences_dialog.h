// What people set for this machine: theme, mouse, memory, threads, recent files.
#pragma once

#include <functional>

#include <QDialog>

#include "widgets/preferences.h"

class QFormLayout;
class QLabel;
class QTreeWidget;

namespace pellucid::gui {

/// Changes hold at once and are kept.
class PreferencesDialog : public QDialog {
    Q_OBJECT
public:
    struct Hooks {
        std::function<void()> changed;     ///< what is kept is another one
        std::function<void()> clearRecent; ///< forgets the recent files and their pictures
        std::function<bool()> hasRecent;   ///< whether there are any
    };
    PreferencesDialog(Hooks hooks, QWidget* parent);

private:
    QWidget* addRow(QFormLayout& form, const char* key);
    QWidget* controlOf(const Setting& setting);
    QWidget* numberOf(const Setting& setting);
    QWidget* wholeOf(const Setting& setting);
    QWidget* choiceOf(const Setting& setting);
    QWidget* flagOf(const Setting& setting);
    QWidget* mouseTable();
    void edit(const std::function<void()>& change);
    void restoreDefaults();
    void follow();

    Hooks m_hooks;
    Preferences m_now;
    std::vector<std::function<void()>> m_show;
    QTreeWidget* m_mouse;
    QLabel* m_memoryNow;
    QWidget* m_clear;
};

} // namespace pellucid::gui
