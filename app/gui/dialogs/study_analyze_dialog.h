// Whose answers of a study are analysed.
#pragma once

#include <QDialog>

#include "study/analysis.h"

class QCheckBox;
class QDialogButtonBox;
class QLabel;
class QLineEdit;
class QListWidget;

namespace pellucid::gui {

class StudyAnalyzeDialog : public QDialog {
    Q_OBJECT
public:
    explicit StudyAnalyzeDialog(const QString& folder, QWidget* parent = nullptr);

    QString folder() const;
    StudyAnalysisOptions options() const;

private:
    void follow(); ///< lists who has taken part in the folder's study

    QLineEdit* m_folder;
    QListWidget* m_participants;
    QCheckBox* m_rules;
    QLabel* m_about;
    QDialogButtonBox* m_buttons;
};

} // namespace pellucid::gui
