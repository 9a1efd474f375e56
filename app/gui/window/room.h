// How the room of the window is shared out: a layout of panels for each task, and a mode with the picture alone.
#pragma once

#include <QByteArray>
#include <QMainWindow>

#include "base/enum_names.h"

class QHBoxLayout;
class QLabel;

namespace pellucid::gui {

class Services;
class TargetBars;

/// What somebody is doing, which says what panels are open.
enum class Task { Explore, Targets, Series, Slices };

/// Remembers on this machine how each task's layout was left.
class Room : public QObject {
    Q_OBJECT
public:
    /// `row`: the picture stands in it; beside it there is room for the bars of the focus mode.
    Room(QMainWindow& window, Services& services, QHBoxLayout& row);

    /// In the menu View. Before the panels are added, so that they stand behind.
    void addActions();
    /// All panels are there, as they are at the first start.
    void panelsAdded();
    void restore();
    /// Shares out the window at its first show, unless a layout has been restored.
    void shown();
    void save();

    Task task() const { return m_task; }
    void choose(Task task);
    void reset(); ///< the present task's layout as it was at first
    bool isFocused() const { return m_bars != nullptr; }
    /// The picture and the features' bars, and nothing else; or all that was there before.
    void setFocused(bool focused);

protected:
    /// Tab in the picture changes the focus mode.
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void showFirst(Task task);
    void shareOut();

    QMainWindow& m_window;
    Services& m_services;
    QHBoxLayout& m_row;
    Task m_task = Task::Explore;
    bool m_arranged = false;         ///< the docks have the sizes that they were left with, or those of the first start
    QByteArray m_first, m_unfocused; ///< states of the docks: at the first start, and before the focus mode
    TargetBars* m_bars = nullptr;    ///< while focused
};

} // namespace pellucid::gui
template <>
inline constexpr auto pellucid::kNamesOf<pellucid::gui::Task> = pellucid::enumNames("task", "explore", "targets",
                                                                                    "series", "slices");
