#include "dialogs/study_dialog.h"

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>

#include "dialogs/closing_buttons.h"
#include "render/render_settings.h"
#include "widgets/elided.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {
namespace {

enum Column { kId, kFeature, kLabel, kPractice, kStudyColumns };

/// Texts of several lines.
bool isLong(const Setting& setting) {
    return std::string_view(setting.key) == "consent" || std::string_view(setting.key) == "instructions";
}

} // namespace

StudyDialog::StudyDialog(Study study, QWidget* parent)
    : QDialog(parent), m_study(std::move(study)),
      m_width(named(new QSpinBox(this), "studyWidth", tr("Width of the pictures, pixels"))),
      m_height(named(new QSpinBox(this), "studyHeight", tr("Height of the pictures, pixels"))),
      m_stimuli(named(new QTableWidget(this), "studyStimuli",
                      tr("The views that are shown, the feature each asks about, and its word in the question"))) {
    setObjectName("studyDialog");
    setWindowTitle(tr("Study"));
    auto* form = new QFormLayout;
    form->setVerticalSpacing(9);
    for (const Setting& setting : settingsOf<Study>())
        form->addRow(QString::fromUtf8(setting.words), controlOf(setting));
    for (QSpinBox* box : {m_width, m_height}) {
        box->setRange(kSmallestPicture, kMostPixels);
        box->setSuffix(tr(" px"));
    }
    m_stimuli->setAccessibleName(tr("Stimuli"));
    m_height->setAccessibleName(tr("Height"));
    m_width->setValue(m_study.width);
    m_height->setValue(m_study.height);
    addRow(*form, tr("Si&ze"), m_width,
           rowOf({m_width, new QLabel(QStringLiteral("×"), this), m_height, Cell::rest()}));
    auto* labels = rowOf({});
    for (int score = kLowestScore; score <= kHighestScore; ++score) {
        auto* edit = named(new QLineEdit(this), QStringLiteral("studyScore%1").arg(score),
                           tr("What score %1 is called").arg(score));
        edit->setAccessibleName(tr("Score %1").arg(score));
        edit->setPlaceholderText(QString::number(score));
        if (const auto at = m_study.labels.find(score); at != m_study.labels.end())
            edit->setText(QString::fromStdString(at->second));
        m_labels.push_back(edit);
        labels->addWidget(edit);
    }
    form->addRow(tr("Scores 1 to 5"), labels);
    form->addRow(tr("Stimuli"), makeStimuli());
    auto* all = inset(columnOf({{form, 1}, closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel)}),
                      {18, 16, 18, 12});
    setLayout(all);
    resize(720, 760);
}

QWidget* StudyDialog::controlOf(const Setting& setting) {
    const QString id = "study_" + QString::fromUtf8(setting.key), tip = QString::fromUtf8(setting.help);
    const QString unit = QString::fromStdString(setting.unitText());
    const std::string text = textOf(setting, &m_study);
    if (isLong(setting)) {
        auto* edit = named(new QPlainTextEdit(QString::fromStdString(text), this), id, tip);
        edit->setMaximumHeight(72);
        edit->setTabChangesFocus(true);
        m_take.emplace_back([&setting, edit](Study& s) { setText(setting, &s, edit->toPlainText().toStdString()); });
        return edit;
    }
    const SettingValue value = setting.at(&m_study);
    if (const auto* whole = std::get_if<int*>(&value)) {
        auto* box = named(new QSpinBox(this), id, tip);
        box->setRange(static_cast<int>(setting.range.lo), static_cast<int>(setting.range.hi));
        box->setSuffix(unit);
        box->setValue(**whole);
        m_take.emplace_back([&setting, box](Study& s) { *std::get<int*>(setting.at(&s)) = box->value(); });
        return box;
    }
    if (const auto* number = std::get_if<double*>(&value)) {
        constexpr double kLeast = 0.001;
        auto* box = named(new QDoubleSpinBox(this), id, tip);
        box->setDecimals(3);
        box->setRange(setting.range.open == NumberRange::Open::Low ? kLeast : setting.range.lo, setting.range.hi);
        box->setSuffix(unit);
        box->setValue(**number);
        m_take.emplace_back([&setting, box](Study& s) { *std::get<double*>(setting.at(&s)) = box->value(); });
        return box;
    }
    auto* edit = named(new QLineEdit(QString::fromStdString(text), this), id, tip);
    m_take.emplace_back([&setting, edit, shown = edit->text()](Study& s) {
        if (edit->text() != shown) // else it stays as it is in the file, where it may have several lines
            setText(setting, &s, edit->text().toStdString());
    });
    return edit;
}

QWidget* StudyDialog::makeStimuli() {
    m_stimuli->setColumnCount(kStudyColumns);
    elideInTheMiddle(*m_stimuli);
    m_stimuli->setHorizontalHeaderLabels({tr("Stimulus"), tr("Feature"), tr("Word"), tr("Practice")});
    m_stimuli->horizontalHeader()->setSectionResizeMode(kLabel, QHeaderView::Stretch);
    m_stimuli->verticalHeader()->hide();
    m_stimuli->setSelectionBehavior(QAbstractItemView::SelectRows);
    m_stimuli->setSelectionMode(QAbstractItemView::SingleSelection);
    fillStimuli();
    auto* box = new QWidget(this);
    auto* buttons = columnOf({});
    const auto add = [&](const char* id, const QString& text, const auto& press) {
        auto* button = named(new QPushButton(text, box), id);
        button->setAutoDefault(false);
        connect(button, &QPushButton::clicked, this, press);
        buttons->addWidget(button);
    };
    add("stimulusUp", tr("Up"), [this] { moveStimulus(-1); });
    add("stimulusDown", tr("Down"), [this] { moveStimulus(1); });
    add("stimulusRemove", tr("Remove"), [this] { removeStimulus(); });
    buttons->addStretch(1);
    box->setLayout(inset(rowOf({{m_stimuli, 1}, buttons}), {}));
    return box;
}

void StudyDialog::fillStimuli() {
    m_stimuli->setRowCount(static_cast<int>(m_study.stimuli.size()));
    for (int row = 0; row < m_stimuli->rowCount(); ++row) {
        const Stimulus& s = m_study.stimuli[static_cast<std::size_t>(row)];
        const auto put = [&](int column, const std::string& text, Qt::ItemFlags flags) {
            auto* item = new QTableWidgetItem(QString::fromStdString(text));
            item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | flags);
            m_stimuli->setItem(row, column, item);
            return item;
        };
        put(kId, s.id, {})->setToolTip(QString::fromStdString(s.session.empty() ? s.volume : s.session));
        put(kFeature, s.feature, {});
        put(kLabel, s.label, Qt::ItemIsEditable);
        put(kPractice, "", Qt::ItemIsUserCheckable)->setCheckState(s.training ? Qt::Checked : Qt::Unchecked);
    }
}

Study StudyDialog::study() const {
    Study edited = m_study;
    for (const auto& take : m_take) take(edited);
    edited.width = m_width->value();
    edited.height = m_height->value();
    edited.labels.clear();
    for (std::size_t i = 0; i < m_labels.size(); ++i)
        if (const QString text = m_labels[i]->text().trimmed(); !text.isEmpty())
            edited.labels[kLowestScore + static_cast<int>(i)] = text.toStdString();
    for (int row = 0; row < m_stimuli->rowCount(); ++row) {
        Stimulus& s = edited.stimuli[static_cast<std::size_t>(row)];
        s.label = m_stimuli->item(row, kLabel)->text().trimmed().toStdString();
        s.training = m_stimuli->item(row, kPractice)->checkState() == Qt::Checked;
    }
    return edited;
}

void StudyDialog::moveStimulus(int by) {
    const int from = m_stimuli->currentRow(), to = from + by;
    if (from < 0 || to < 0 || to >= m_stimuli->rowCount()) return;
    m_study.stimuli = study().stimuli; // labels and marks that were typed go along
    std::swap(m_study.stimuli[static_cast<std::size_t>(from)], m_study.stimuli[static_cast<std::size_t>(to)]);
    fillStimuli();
    m_stimuli->selectRow(to);
}

void StudyDialog::removeStimulus() {
    const int row = m_stimuli->currentRow();
    if (row < 0) return;
    m_study.stimuli = study().stimuli;
    m_study.stimuli.erase(m_study.stimuli.begin() + row);
    fillStimuli();
    if (m_stimuli->rowCount() > 0) m_stimuli->selectRow(std::min(row, m_stimuli->rowCount() - 1));
}

} // namespace pellucid::gui
