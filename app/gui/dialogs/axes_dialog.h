// How the axes of the data run.
#pragma once

#include <array>

#include <QDialog>

#include "volume/grid_axes.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;

namespace pellucid::gui {

class AxesDialog : public QDialog {
    Q_OBJECT
public:
    /// `dims`: voxels along i, j, k.
    AxesDialog(const GridAxes& now, const Int3& dims, QWidget* parent = nullptr);
    GridAxes axes() const;

private:
    void fill(const GridAxes& axes); ///< in the words of a patient, or of x, y, z
    void check();

    std::array<QComboBox*, 3> m_along;
    QCheckBox* m_patient;
    QLabel* m_verdict;
    QPushButton* m_ok;
};

} // namespace pellucid::gui
