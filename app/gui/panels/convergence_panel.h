// How optimizations go, and went: F, VWS and opacities over the moves, and the session's runs to compare.
#pragma once

#include <array>
#include <set>

#include <QWidget>

#include "report/plot.h"
#include "session/session.h"

class QBoxLayout;
class QCheckBox;
class QLabel;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace pellucid::gui {

class PlotView;
class OptimizeController;
class SaveController;
class Services;

/// Three plots and a list. The first has F of all runs that are checked in the list; the others VWS and opacities of
/// the one that is selected. While an optimization runs, it is checked and selected, and the plots follow its moves.
/// A click on a dot shows the transfer function of that move.
class ConvergencePanel : public QWidget {
    Q_OBJECT
public:
    ConvergencePanel(Services& services, OptimizeController& optimizing, SaveController& saving, QWidget* parent);

    /// Writes what is shown, by the suffix: .csv (the runs' curves), .png or .svg (the plots). Errors are shown.
    void exportTo(const QString& path);

protected:
    void showEvent(QShowEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override; ///< F2 and Del in the list

private:
    static constexpr int kUnderWay = 0; ///< in place of the number of a run that has not ended

    void makePlots();
    void makeList();
    void follow(); ///< runs have come or gone
    void fillList();
    void drawPlots();
    const Run* runNumbered(int number) const; ///< null where there is none
    const Run* shownRun() const;              ///< whose VWS and opacities are plotted; null: none
    std::vector<const Run*> comparedRuns() const;
    std::vector<Plot> plots() const;
    void showMove(const Run& run, int move);
    void itemChanged(QTreeWidgetItem* item);
    void chooseFile(const QString& suffix);
    void showMenu(const QPoint& global, bool ofList);
    void rename();
    void remove();
    void clear();

    Services& m_services;
    OptimizeController& m_optimizing;
    SaveController& m_saving;
    std::array<PlotView*, 3> m_plots{};
    QBoxLayout* m_row;
    QTreeWidget* m_list;
    QCheckBox* m_log;
    QLabel* m_readOut;
    QToolButton *m_start, *m_export;
    std::set<int> m_compared; ///< numbers
    int m_shown = -1;         ///< number; −1: the latest
    int m_latest = 0;         ///< the highest number that was there: what is above is new
};

} // namespace pellucid::gui
