// The dock of the transfer function: the curve, and the selected points in numbers.
#pragma once

#include <QWidget>

#include "tf/tf_canvas.h"

class QCheckBox;
class QDoubleSpinBox;
class QLabel;
class QMenu;
class QToolButton;

namespace pellucid::gui {

class FittingRow;

class TfEditorWidget : public QWidget {
    Q_OBJECT
public:
    TfEditorWidget(SessionStore& store, Results& results, Selection& selection, QWidget* parent = nullptr);

    TfCanvas& canvas() { return *m_canvas; }
    void setReadOnly(bool on);
    /// Puts the numbers of the selected points and the menu of the plot into a row around the editor.
    void fill(FittingRow& row);

private:
    void fillPlotMenu(QMenu& menu);
    void showPoints();
    void editPoints(const QDoubleSpinBox& box);

    SessionStore& m_store;
    TfCanvas* m_canvas;
    QLabel* m_which;
    QDoubleSpinBox* m_value;
    QDoubleSpinBox* m_opacity;
    QToolButton* m_color;
    QCheckBox* m_fixed; ///< partly checked: some of them are
    QToolButton* m_remove;
    QToolButton* m_plot; ///< with a menu
    bool m_readOnly = false;
    const QDoubleSpinBox* m_typed = nullptr; ///< typed into, not yet taken
    int m_editSession = 0;                   ///< so that the steps of one stay at a point become one undo step
};

} // namespace pellucid::gui
