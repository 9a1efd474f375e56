// Which parts of a transfer function are taken.
#pragma once

#include <QDialog>

#include "tf/formats/tf_parts.h"

class QCheckBox;

namespace pellucid::gui {

class TfPartsDialog : public QDialog {
    Q_OBJECT
public:
    /// `name`: of the file. What it does not have cannot be chosen.
    TfPartsDialog(const QString& name, const TfParts& has, const QStringList& notices, QWidget* parent = nullptr);
    TfParts parts() const;

private:
    QCheckBox *m_colors, *m_opacities, *m_range;
};

} // namespace pellucid::gui
