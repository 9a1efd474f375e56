#include "dialogs/series_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

#include "dialogs/series_files.h"

namespace pellucid::gui {
namespace {

constexpr int kPause = 200; ///< ms

} // namespace

SeriesDialog::SeriesDialog(const QString& folder, QWidget* parent)
    : QDialog(parent), m_folder(folder), m_path(new QLineEdit(this)), m_first(new QSpinBox(this)),
      m_last(new QSpinBox(this)), m_every(new QSpinBox(this)), m_found(new QLabel(this)),
      m_listing([](const VolumeSource& source, const JobControl& job) { return listSeries(source, job); },
                [this](const VolumeSource&, SeriesListing& listing) { show(listing); }) {
    setObjectName("seriesDialog");
    setWindowTitle(tr("Open series"));
    auto* form = new QFormLayout(this);
    form->setContentsMargins(18, 16, 18, 12);
    form->setVerticalSpacing(9);
    m_path->setObjectName("seriesPath");
    m_path->setMinimumWidth(380);
    m_path->setPlaceholderText(tr("folder, or pattern such as run/f%03d.mhd or run/f*.mhd"));
    m_path->setToolTip(tr("A folder of volumes; a pattern with a number (%02d) or wildcards (* ?); or a file with "
                          "several time steps"));
    auto* folderButton = new QPushButton(tr("F&older…"), this);
    auto* filesButton = new QPushButton(tr("&Files…"), this);
    folderButton->setObjectName("seriesFolder");
    filesButton->setObjectName("seriesFiles");
    auto* where = new QHBoxLayout;
    where->addWidget(m_path, 1);
    where->addWidget(folderButton);
    where->addWidget(filesButton);
    form->addRow(tr("Frames of"), where);
    auto* range = new QHBoxLayout;
    const std::tuple<QSpinBox*, const char*, QString, QString> boxes[] = {
        {m_first, "seriesFirst", tr("from "), tr("First frame, counted from 0")},
        {m_last, "seriesLast", tr("to "), tr("Last frame, itself included")},
        {m_every, "seriesEvery", tr("every "), tr("Of these frames each n-th")}};
    for (const auto& [box, name, prefix, tip] : boxes) {
        box->setObjectName(name);
        box->setPrefix(prefix);
        box->setToolTip(tip);
        range->addWidget(box, 1);
    }
    form->addRow(tr("Only"), range);
    m_found->setObjectName("seriesFound");
    m_found->setWordWrap(true);
    m_found->setTextFormat(Qt::PlainText);
    form->addRow(m_found);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Open | QDialogButtonBox::Cancel, this);
    m_ok = buttons->button(QDialogButtonBox::Open);
    m_ok->setObjectName("seriesOpen");
    form->addRow(buttons);
    setRange(0);

    m_pause.setSingleShot(true);
    m_pause.setInterval(kPause);
    connect(&m_pause, &QTimer::timeout, this, &SeriesDialog::look);
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
        m_found->setText(QString::fromUtf8(error.what()));
    });
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

VolumeSource SeriesDialog::named() const {
    if (!m_files.isEmpty()) return sourceOf(m_files);
    VolumeSource source;
    source.path = m_path->text().trimmed().toStdString();
    return source;
}

VolumeSource SeriesDialog::source() const {
    VolumeSource source = named();
    if (m_first->value() > 0 || m_last->value() < m_last->maximum() || m_every->value() > 1)
        source.frames = FrameRange{m_first->value(), m_last->value(), m_every->value()};
    return source;
}

void SeriesDialog::look() {
    const VolumeSource source = named();
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
