#include "dialogs/study_analyze_dialog.h"

#include <QCheckBox>
#include <QDir>
#include <QFileInfo>
#include <QFormLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>

#include "dialogs/closing_buttons.h"
#include "dialogs/study_files.h"
#include "report/page_parts.h"
#include "widgets/controls.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"

namespace pellucid::gui {

StudyAnalyzeDialog::StudyAnalyzeDialog(const QString& folder, QWidget* parent)
    : QDialog(parent),
      m_folder(named(new QLineEdit(folder, this), "studyFolder", tr("The folder that a study was prepared into"))),
      m_participants(named(new QListWidget(this), "studyParticipants",
                           tr("Participants: those who are not checked are left out of the analysis"))),
      m_rules(named(new QCheckBox(tr("&Leave out deficient colour vision and inconsistent answers"), this),
                    "studyRules",
                    tr("Leaves out those who report a colour vision deficiency, and those whose scores of\n"
                       "repeated pictures differ far more than other people's. The report says who and why"))),
      m_about(wrappedLabel("studyAbout", this)),
      m_buttons(closingButtons(*this, QDialogButtonBox::Ok | QDialogButtonBox::Cancel)) {
    setObjectName("studyAnalyzeDialog");
    setWindowTitle(tr("Analyze a study"));
    elideInTheMiddle(*m_participants);
    m_rules->setChecked(true);
    connect(m_folder, &QLineEdit::textChanged, this, &StudyAnalyzeDialog::follow);
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(tr("&Prepared study"), preparedStudyRow(*m_folder, *this));
    form->addRow(tr("P&articipants"), m_participants);
    form->addRow(m_rules);
    form->addRow(m_about);
    m_buttons->button(QDialogButtonBox::Ok)->setText(tr("Analyze"));
    form->addRow(m_buttons);
    follow();
}

void StudyAnalyzeDialog::follow() {
    m_participants->clear();
    QString about;
    try {
        readPreparedStudy(folder().toStdString());
        for (const Participant& p : readParticipants(folder().toStdString())) {
            auto* item = new QListWidgetItem(QString::fromStdString(p.id), m_participants);
            item->setCheckState(Qt::Checked);
        }
        if (m_participants->count() == 0)
            about = tr("Nobody has taken part yet.");
        else if (QFileInfo::exists(QDir(folder()).filePath(kReportFile)))
            about = tr("The report that is in the folder will be replaced.");
    } catch (const Error& error) {
        if (!folder().isEmpty()) about = QString::fromStdString(error.what());
    }
    m_about->setText(about);
    m_buttons->button(QDialogButtonBox::Ok)->setEnabled(m_participants->count() > 0);
}

QString StudyAnalyzeDialog::folder() const { return m_folder->text().trimmed(); }

StudyAnalysisOptions StudyAnalyzeDialog::options() const {
    StudyAnalysisOptions options;
    options.keepAll = !m_rules->isChecked();
    for (int i = 0; i < m_participants->count(); ++i)
        if (const QListWidgetItem& item = *m_participants->item(i); item.checkState() != Qt::Checked)
            options.exclude.push_back(item.text().toStdString());
    return options;
}

} // namespace pellucid::gui
