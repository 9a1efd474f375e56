// The dock that tells how each feature's VWS follows each opacity.
#pragma once

#include <QWidget>

#include "results.h"
#include "store/session_store.h"

class QAction;
class QTableWidget;

namespace pellucid::gui {

/// A square table of ∂W_i/∂x_j of the present state: row i a feature's VWS, column j a feature's opacity. Pale while
/// the figures are of an older state.
class InfluencePanel : public QWidget {
    Q_OBJECT
public:
    InfluencePanel(SessionStore& store, Results& results, QWidget* parent = nullptr);

private:
    void showEvent(QShowEvent* event) override;
    void changeEvent(QEvent* event) override;
    void rebuild();
    /// Values and colours, in the cells that are there.
    void refresh();
    /// The table as lines of tab-separated columns, names first, with all digits; nothing while it is of an older
    /// state.
    void copy() const;

    SessionStore& m_store;
    Results& m_results;
    QTableWidget* m_table;
    QAction* m_copyAction;
};

} // namespace pellucid::gui
