// The window: the picture in the middle, panels around it, menus and status line. The work is done elsewhere.
#pragma once

#include <memory>

#include <QMainWindow>

#include "services/services.h"
#include "view/view_grid.h"
#include "view/volume_view.h"

class QHBoxLayout;

namespace pellucid::gui {

class DockScroll;
class Room;
class StatusLine;
struct PanelInfo;
struct Controllers;

class MainWindow : public QMainWindow {
    Q_OBJECT
public:
    explicit MainWindow(ViewRenderer renderer = ViewRenderer::Auto, QWidget* parent = nullptr);
    ~MainWindow() override;

    Services& services() { return *m_services; }
    Controllers& controllers() { return *m_controllers; }
    VolumeView& view() { return *m_view; }
    ViewGrid& views() { return *m_views; }

    /// Size, place and docks as the last window was closed with.
    void restoreLayout();
    Room& room() { return *m_room; }
    /// A card beside the picture, if nobody has dismissed it: for a start on a sample.
    void welcome();
    /// The status line says how much memory is in use, which no two runs have alike.
    void watchMemory();
    /// The picture is as good as it gets, the figures are of the present state, and nothing is under way.
    bool isSettled() const;

Q_SIGNALS:
    void settledChanged(); ///< isSettled() may have changed

protected:
    void changeEvent(QEvent* event) override;
    void closeEvent(QCloseEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;

private:
    void addPanels();
    void addPanelActions(const std::vector<PanelInfo>& panels);
    void togglePanel(QDockWidget& dock, const DockScroll& content);
    void addHelpActions();
    void showPreferences();
    void updateTitle();
    void describePicture(); ///< to those who hear the window in place of seeing it

    std::unique_ptr<Services> m_services;
    std::unique_ptr<Controllers> m_controllers;
    VolumeView* m_view;
    ViewGrid* m_views;  // with m_view in it
    QHBoxLayout* m_row; // with m_views in it
    Room* m_room;
    StatusLine* m_status;
};

} // namespace pellucid::gui
