// How far the voxels of the data are apart.
#pragma once

#include <array>

#include <QDialog>

#include "volume/grid_spacing.h"

class QComboBox;
class QDoubleSpinBox;
class QFormLayout;

namespace pellucid::gui {

/// The distances along three axes and their unit, for forms.
class SpacingFields : public QObject {
    Q_OBJECT
public:
    /// `noUnit`: what it is called where no unit is chosen.
    SpacingFields(QWidget* parent, const QString& noUnit);
    void addTo(QFormLayout& form);
    void setValue(const GridSpacing& spacing);
    GridSpacing value() const;

private:
    std::array<QDoubleSpinBox*, 3> m_distances;
    QComboBox* m_unit;
    GridSpacing m_given; ///< what the fields began with, which has more digits than they show
};

class SpacingDialog : public QDialog {
    Q_OBJECT
public:
    explicit SpacingDialog(const GridSpacing& now, QWidget* parent = nullptr);
    GridSpacing spacing() const { return m_fields->value(); }

private:
    SpacingFields* m_fields;
};

} // namespace pellucid::gui
