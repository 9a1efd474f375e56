// The dock that tells how each feature's VWS follows each opacity, and who hides whom.
#pragma once

#include <QWidget>

#include "services/results.h"
#include "store/session_store.h"

class QAction;
class QComboBox;
class QTableWidget;

namespace pellucid::gui {

/// A square table of the present state, as a heat map: ∂W_i/∂x_j, row i a feature's VWS, column j a feature's opacity;
/// or the part of feature i that feature j hides. Pale while the figures are of an older state.
class InfluencePanel : public QWidget {
    Q_OBJECT
public:
    InfluencePanel(SessionStore& store, Results& results, QWidget* parent = nullptr);

private:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void changeEvent(QEvent* event) override;
    void fitColumns();
    void rebuild();
    /// What the table shows: the influence, or who hides whom. Null before it is known.
    const std::vector<std::vector<double>>* matrix() const;
    QString cellText(double value) const;
    QString cellTip(int row, int column, double value) const;
    /// Values and colours, in the cells that are there.
    void refresh();
    /// The table as lines of tab-separated columns, names first, with all digits; nothing while it is of an older
    /// state.
    void copy() const;

    SessionStore& m_store;
    Results& m_results;
    QComboBox* m_what;
    QTableWidget* m_table;
    QAction* m_copyAction;
    bool m_fitsLater = false;
};

} // namespace pellucid::gui
