#include "dialogs/series_choice_dialog.h"

#include <algorithm>

#include <QDialogButtonBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QVBoxLayout>

#include "dialogs/closing_buttons.h"
#include "dialogs/slice_picture.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

constexpr int kFramePicture = 96;

/// What a list shows before the picture is there, and where it cannot be read.
QPixmap emptyPicture(const QWidget& widget) {
    return swatchOf(widget.palette().color(QPalette::AlternateBase), kFramePicture, kFramePicture);
}

} // namespace

SeriesChoiceDialog::SeriesChoiceDialog(const VolumeSource& source, const FileContents& contents, QWidget* parent)
    : QDialog(parent), m_names(contents.arrays),
      m_list(named(new QListWidget(this), "seriesList", tr("Double-click a volume to open it"))),
      m_pictures(
          &SeriesChoiceDialog::pictureOf,
          [this](const Asked& asked, QImage& image) {
              if (image.isNull()) return;
              m_list->item(asked.row)->setIcon(QPixmap::fromImage(
                  image.scaled(kFramePicture, kFramePicture, Qt::KeepAspectRatio, Qt::SmoothTransformation)));
          },
          WhenBusy::Queue) {
    setObjectName("seriesChoiceDialog");
    setWindowTitle(tr("Choose a volume"));
    auto* what = wrappedLabel("seriesWhat", this);
    what->setText(tr("%L1 volumes were found. Which one do you want to open?").arg(m_names.size()));
    m_list->setIconSize({kFramePicture, kFramePicture});
    m_list->setMinimumSize(460, 360);
    m_list->setSpacing(3);
    for (std::size_t i = 0; i < m_names.size(); ++i) {
        QString text = QString::fromStdString(m_names[i]);
        if (i < contents.details.size()) text += QStringLiteral("\n") + QString::fromStdString(contents.details[i]);
        m_list->addItem(new QListWidgetItem(QIcon(emptyPicture(*this)), text));
        VolumeSource asked = source;
        asked.array = m_names[i];
        m_pictures.start({asked, static_cast<int>(i)});
    }
    auto* buttons = closingButtons(*this, QDialogButtonBox::Open | QDialogButtonBox::Cancel);
    add(*inset(new QVBoxLayout(this), {18, 16, 18, 12}), {what, {m_list, 1}, buttons});
    connect(m_list, &QListWidget::itemActivated, this, &QDialog::accept);
    const auto first = std::ranges::find(m_names, contents.array);
    m_list->setCurrentRow(first == m_names.end() ? 0 : static_cast<int>(first - m_names.begin()));
    m_list->setFocus();
}

std::string SeriesChoiceDialog::series() const { return m_names.at(static_cast<std::size_t>(m_list->currentRow())); }

/// Empty where the series cannot be read: opening it says why.
QImage SeriesChoiceDialog::pictureOf(const Asked& asked, const JobControl& job) {
    try {
        return pictureOfSlice(loadMiddleSlice(asked.source, {job.stop, {}}));
    } catch (const Error&) {
        return {};
    }
}

} // namespace pellucid::gui
