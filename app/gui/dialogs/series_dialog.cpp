#include "dialogs/series_dialog.h"

#include <QFileDialog>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

#include "dialogs/closing_buttons.h"
#include "dialogs/series_files.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {

SeriesDialog::SeriesDialog(const QString& folder, QWidget* parent)
    : QDialog(parent), m_folder(folder), m_path(new QLineEdit(this)), m_first(new QSpinBox(this)),
      m_last(new QSpinBox(this)), m_every(new QSpinBox(this)), m_found(wrappedLabel("seriesFound", this)),
      m_listing([](const VolumeSource& source, const JobControl& job) { return listSeries(source, job); },
                [this](const VolumeSource&, SeriesListing& listing) { show(listing); }) {
    setObjectName("seriesDialog");
    setWindowTitle(tr("Open series"));
    named(m_path, "seriesPath",
          tr("A folder of volumes; a pattern with a number (%02d) or wildcards (* ?); or a file with several time "
             "steps"));
    m_path->setMinimumWidth(380);
    m_path->setPlaceholderText(tr("folder, or pattern such as run/f%03d.mhd or run/f*.mhd"));
    auto* folderButton = named(new QPushButton(tr("F&older…"), this), "seriesFolder", tr("All volumes of a folder"));
    auto* filesButton = named(new QPushButton(tr("&Files…"), this), "seriesFiles",
                              tr("Files one by one, in the order in which people count"));
    named(m_first, "seriesFirst", tr("First frame, counted from 0"))->setPrefix(tr("from "));
    named(m_last, "seriesLast", tr("Last frame, included"))->setPrefix(tr("to "));
    named(m_every, "seriesEvery", tr("Every n-th of these frames"))->setPrefix(tr("every "));
    m_found->setTextFormat(Qt::PlainText);
    auto* buttons = closingButtons(*this, QDialogButtonBox::Open | QDialogButtonBox::Cancel);
    m_ok = named(buttons->button(QDialogButtonBox::Open), "seriesOpen");
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    addRow(*form, tr("F&rames of"), m_path, rowOf({{m_path, 1}, folderButton, filesButton}));
    form->addRow(tr("Only"), rowOf({{m_first, 1}, {m_last, 1}, {m_every, 1}}));
    form->addRow(m_found);
    form->addRow(buttons);
    m_first->setAccessibleName(tr("First frame"));
    m_last->setAccessibleName(tr("Last frame"));
    m_every->setAccessibleName(tr("Every n-th frame"));
    setRange(0);

    connect(m_path, &QLineEdit::textEdited, this, [this] {
        m_files.clear();
        setRange(0);
        m_pause.start();
    });
    connect(folderButton, &QPushButton::clicked, this, [this] {
        const QString chosen = QFileDialog::getExistingDirectory(this, tr("Folder of the frames"), m_folder);
        if (chosen.isEmpty()) return;
        m_files.clear();
        m_path->setText(chosen);
        look();
    });
    connect(filesButton, &QPushButton::clicked, this, [this] {
        const QStringList chosen = QFileDialog::getOpenFileNames(this, tr("Files of the frames"), m_folder);
        if (chosen.isEmpty()) return;
        m_files = chosen;
        m_path->setText(titleOf(sourceOf(m_files)));
        look();
    });
    connect(&m_listing, &JobBase::failed, this, [this](const Error& error) {
        setRange(0);
        m_found->setText(error.what());
    });
}

VolumeSource SeriesDialog::allFrames() const {
    if (!m_files.isEmpty()) return sourceOf(m_files);
    VolumeSource source;
    source.path = m_path->text().trimmed().toStdString();
    return source;
}

VolumeSource SeriesDialog::source() const {
    VolumeSource source = allFrames();
    if (m_first->value() > 0 || m_last->value() < m_last->maximum() || m_every->value() > 1)
        source.frames = FrameRange{m_first->value(), m_last->value(), m_every->value()};
    return source;
}

void SeriesDialog::look() {
    const VolumeSource source = allFrames();
    if (source.path.empty()) {
        m_listing.cancel();
        m_found->clear();
        return setRange(0);
    }
    m_found->setText(tr("Looking…"));
    m_listing.start(source, QString::fromStdString(source.path));
}

void SeriesDialog::show(const SeriesListing& listing) {
    const auto count = static_cast<int>(listing.frames.size());
    setRange(count);
    QStringList lines;
    if (count == 1)
        lines << tr("One frame: %1").arg(QString::fromStdString(listing.frames.front().name));
    else
        lines << tr("%L1 frames: %2 … %3")
                     .arg(count)
                     .arg(QString::fromStdString(listing.label(0)), QString::fromStdString(listing.label(count - 1)));
    constexpr std::size_t kMostNotices = 3;
    for (std::size_t i = 0; i < std::min(kMostNotices, listing.notices.size()); ++i)
        lines << QString::fromStdString(listing.notices[i]);
    m_found->setText(lines.join('\n'));
}

void SeriesDialog::setRange(int count) {
    m_ok->setEnabled(count > 0);
    const int last = std::max(0, count - 1);
    m_first->setRange(0, last);
    m_last->setRange(0, last);
    m_every->setRange(1, std::max(1, count));
    m_first->setValue(0);
    m_last->setValue(last);
    m_every->setValue(1);
    for (QSpinBox* box : {m_first, m_last, m_every}) box->setEnabled(count > 1);
}

} // namespace pellucid::gui
