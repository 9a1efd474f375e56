// The dock of the transfer function: the curve, and the selected points in numbers.
#pragma once

#include <QWidget>

#include "tf/tf_canvas.h"

class QCheckBox;
class QDoubleSpinBox;
class QHBoxLayout;
class QLabel;
class QToolButton;
class QVBoxLayout;

namespace pellucid::gui {

class TfEditorWidget : public QWidget {
    Q_OBJECT
public:
    TfEditorWidget(SessionStore& store, Results& results, Selection& selection, QWidget* parent = nullptr);

    TfCanvas& canvas() { return *m_canvas; }
    void setReadOnly(bool on);
    /// A row of its own right below the canvas, such as what is drawn along the same axis.
    void addRow(QWidget* row);

private:
    QHBoxLayout* makeRow();
    void showPoints();
    void editPoints(const QDoubleSpinBox& box);

    SessionStore& m_store;
    TfCanvas* m_canvas;
    QVBoxLayout* m_column;
    int m_rows = 0; ///< below the canvas
    QLabel* m_which;
    QDoubleSpinBox* m_value;
    QDoubleSpinBox* m_opacity;
    QToolButton* m_color;
    QCheckBox* m_fixed; ///< partly checked: some of them are
    QToolButton* m_remove;
    bool m_readOnly = false;
    const QDoubleSpinBox* m_typed = nullptr; ///< typed into, not yet taken
    int m_editSession = 0;                   ///< so that the steps of one stay at a point become one undo step
};

} // namespace pellucid::gui
