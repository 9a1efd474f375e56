// The dock of the features: what each shows, what it should show, and the buttons that get it there.
#pragma once

#include <QWidget>

#include "models/document.h"
#include "models/features_model.h"
#include "target_bars.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QTableView;

namespace pellucid::gui {

class FeaturesPanel : public QWidget {
    Q_OBJECT
public:
    explicit FeaturesPanel(Document& document, QWidget* parent = nullptr);

    OptimizeOptions options() const;
    /// While an optimization runs nothing can be edited, Optimize becomes Cancel, and the progress shows.
    void setOptimizing(bool on);
    /// After each move: its number, and the distance F from the targets.
    void showMove(int move, double objective);
    void setMessage(const QString& text);

Q_SIGNALS:
    void refineRequested();
    void optimizeRequested();
    void cancelRequested();

private:
    void updateState();
    void adjustTable();

    Document& m_document;
    FeaturesModel* m_model;
    QTableView* m_table;
    TargetBars* m_bars;
    QComboBox* m_method;
    QDoubleSpinBox* m_tolerance;
    QPushButton *m_refine, *m_optimize, *m_cancel, *m_undo, *m_redo;
    QProgressBar* m_progress;
    QLabel *m_distance, *m_message;
    bool m_optimizing = false;
    double m_firstObjective = 0;
};

} // namespace pellucid::gui
