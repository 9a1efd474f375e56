// Who takes part in a prepared study.
#pragma once

#include <QDialog>

class QComboBox;
class QDialogButtonBox;
class QLabel;
class QLineEdit;

namespace pellucid::gui {

class StudyRunDialog : public QDialog {
    Q_OBJECT
public:
    explicit StudyRunDialog(const QString& folder, QWidget* parent = nullptr);

    QString folder() const;
    /// "" for a new one.
    QString participant() const;

private:
    void follow(); ///< says what the folder holds, and offers who has begun

    QLineEdit* m_folder;
    QComboBox* m_participant;
    QLabel* m_about;
    QDialogButtonBox* m_buttons;
};

} // namespace pellucid::gui
