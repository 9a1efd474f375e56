// Which study a view is added to, and which of its features is asked about.
#pragma once

#include <QDialog>
#include <QStringList>

#include "study/add_view.h"

class QCheckBox;
class QComboBox;
class QLineEdit;

namespace pellucid::gui {

class StudyViewDialog : public QDialog {
    Q_OBJECT
public:
    /// `features` is not empty; `selected` the index of the one that is offered first.
    StudyViewDialog(const QString& study, const QStringList& features, int selected, QWidget* parent = nullptr);

    QString study() const; ///< path; "" where none is named
    AskedFeature asked() const;

private:
    QLineEdit *m_study, *m_label;
    QComboBox* m_feature;
    QCheckBox* m_training;
};

} // namespace pellucid::gui
