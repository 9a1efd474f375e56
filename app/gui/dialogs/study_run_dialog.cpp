#include "dialogs/study_run_dialog.h"

#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>

#include "dialogs/closing_buttons.h"
#include "dialogs/study_files.h"
#include "study/answers.h"
#include "study/plan.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

StudyRunDialog::StudyRunDialog(const QString& folder, QWidget* parent)
    : QDialog(parent),
      m_folder(named(new QLineEdit(folder, this), "studyFolder", tr("The folder that a study was prepared into"))),
      m_participant(named(new QComboBox(this), "studyParticipant",
                          tr("A new participant gets a name that tells nothing; one who has begun goes on"))),
      m_about(wrappedLabel("studyAbout", this)),
      m_buttons(closingButtons(*this, QDialogButtonBox::Ok | QDialogButtonBox::Cancel)) {
    setObjectName("studyRunDialog");
    setWindowTitle(tr("Run a study"));
    m_participant->setEditable(true);
    connect(m_folder, &QLineEdit::textChanged, this, &StudyRunDialog::follow);
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(tr("&Prepared study"), preparedStudyRow(*m_folder, *this));
    form->addRow(tr("P&articipant"), m_participant);
    form->addRow(m_about);
    m_buttons->button(QDialogButtonBox::Ok)->setText(tr("Start"));
    form->addRow(m_buttons);
    follow();
}

void StudyRunDialog::follow() {
    m_participant->clear();
    m_participant->addItem(tr("a new participant"));
    bool isGood = false;
    QString about;
    try {
        const Study study = readPreparedStudy(folder().toStdString());
        const std::vector<Participant> participants = readParticipants(folder().toStdString());
        for (const Participant& p : participants)
            if (p.answers.size() < planOf(study, p.id).size()) m_participant->addItem(QString::fromStdString(p.id));
        about = tr("%1: %2 trials, %3 participants so far")
                    .arg(QString::fromStdString(study.title))
                    .arg(planOf(study, "").size())
                    .arg(participants.size());
        isGood = true;
    } catch (const Error& error) {
        if (!folder().isEmpty()) about = QString::fromStdString(error.what());
    }
    m_about->setText(about);
    m_buttons->button(QDialogButtonBox::Ok)->setEnabled(isGood);
}

QString StudyRunDialog::folder() const { return m_folder->text().trimmed(); }

QString StudyRunDialog::participant() const {
    const QString text = m_participant->currentText().trimmed();
    return text == m_participant->itemText(0) ? QString() : text;
}

} // namespace pellucid::gui
