#include "dialogs/study_view_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLineEdit>
#include <QPushButton>

#include "dialogs/closing_buttons.h"
#include "dialogs/study_files.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

StudyViewDialog::StudyViewDialog(const QString& study, const QStringList& features, int selected, QWidget* parent)
    : QDialog(parent),
      m_study(named(new QLineEdit(study, this), "studyFile", tr("The study that gets the view; a new one is begun"))),
      m_label(named(new QLineEdit(this), "studyLabel",
                    tr("The word in the question, such as RED: a colour that everyone finds in the picture"))),
      m_feature(named(new QComboBox(this), "studyFeature", tr("The feature that participants are asked about"))),
      m_training(named(new QCheckBox(tr("For &practice only"), this), "studyTraining",
                       tr("Shown before the others, and left out of the analysis"))) {
    setObjectName("studyViewDialog");
    setWindowTitle(tr("Add this view to a study"));
    m_study->setMinimumWidth(340);
    m_feature->addItems(features);
    m_feature->setCurrentIndex(selected);
    const auto offer = [this] { m_label->setPlaceholderText(m_feature->currentText()); };
    connect(m_feature, &QComboBox::currentIndexChanged, this, offer);
    offer();

    auto* browse = browseButton(*this);
    connect(browse, &QPushButton::clicked, this, [this] {
        const QString chosen = QFileDialog::getSaveFileName(this, tr("Study"), m_study->text(), studyFilter(), nullptr,
                                                            QFileDialog::DontConfirmOverwrite);
        if (!chosen.isEmpty()) m_study->setText(withStudySuffix(chosen));
    });
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    addRow(*form, tr("&Study"), m_study, rowOf({{m_study, 1}, browse}));
    form->addRow(tr("&Feature"), m_feature);
    form->addRow(tr("&Name shown to participants"), m_label);
    form->addRow(QString(), m_training);
    auto* buttons = closingButtons(*this, QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    buttons->button(QDialogButtonBox::Ok)->setText(tr("Add"));
    form->addRow(buttons);
}

QString StudyViewDialog::study() const {
    const QString path = m_study->text().trimmed();
    return path.isEmpty() ? path : withStudySuffix(path);
}

AskedFeature StudyViewDialog::asked() const {
    return {m_feature->currentText().toStdString(), m_label->text().trimmed().toStdString(), m_training->isChecked()};
}

} // namespace pellucid::gui
