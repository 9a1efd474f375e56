// The panel of the features: what each shows, what it should show, and the buttons that get it there.
#pragma once

#include <QWidget>

#include "panels/features_model.h"
#include "panels/target_bars.h"

class QComboBox;
class QLabel;
class QMouseEvent;
class QProgressBar;
class QPushButton;
class QTableView;
class QToolButton;

namespace pellucid::gui {

class DensitySlider;
class Services;
struct Controllers;

class FeaturesPanel : public QWidget {
    Q_OBJECT
public:
    FeaturesPanel(Services& services, Controllers& controllers, QWidget* parent = nullptr);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override; ///< the mouse on eyes and colours

private:
    QWidget* makeShapeRow();
    QWidget* makeTargetRow();
    QWidget* makeColorRow();
    bool pressTable(const QMouseEvent& mouse);
    void select(int row);
    void followSelection();
    void editOptions();
    void follow(); ///< the state, and what is computed of it
    void followRun();
    void showMessage();
    void adjustTable();

    Services& m_services;
    Controllers& m_controllers;
    FeaturesModel* m_model;
    QTableView* m_table;
    TargetBars* m_bars;
    DensitySlider* m_density;
    QToolButton *m_add, *m_colors, *m_targets;
    QComboBox* m_method;
    QPushButton *m_refine, *m_optimize, *m_cancel, *m_undo, *m_redo;
    QProgressBar* m_progress;
    QLabel *m_distance, *m_message;
    bool m_showingSelection = false; ///< the table shows what is selected; it selects nothing
};

} // namespace pellucid::gui
