#include "dialogs/share_dialog.h"

#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "dialogs/closing_buttons.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/named.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// Most voxels of the sizes that are offered, from all on.
constexpr int kSizes[] = {2'000'000'000, 16'777'216, 4'194'304, 1'048'576, 262'144};

QString textOf(const ShareEstimate& size) {
    const QString voxels = QStringLiteral("%1 × %2 × %3").arg(size.dims.x).arg(size.dims.y).arg(size.dims.z);
    const QString megabytes = QObject::tr("about %L1 MB").arg(size.bytes / 1e6, 0, 'f', 1);
    return size.factor == 1 ? QObject::tr("All voxels: %1, %2").arg(voxels, megabytes)
                            : QObject::tr("Coarser by %1: %2, %3").arg(size.factor).arg(voxels, megabytes);
}

} // namespace

ShareDialog::ShareDialog(const ShareOptions& offered, Estimate estimate, QWidget* parent)
    : QDialog(parent), m_estimate(std::move(estimate)),
      m_title(named(new QLineEdit(this), "shareTitle", tr("What stands above the page, and is its name in a browser"))),
      m_path(named(new QLineEdit(offered.path, this), "sharePath",
                   tr("Where the page goes, one file that ends in .html"))),
      m_size(named(new QComboBox(this), "shareSize", tr("Each voxel of a coarser volume is the mean of several"))),
      m_bits(
          named(new QComboBox(this), "shareBits",
                tr("Levels of intensity: 256 with 8 bits, up to 65 536 with 16. As the data need: 8 where they hold\n"
                   "every value, else 16"))),
      m_density(named(new QCheckBox(tr("With a slider for the &density"), this), "shareDensity",
                      tr("Fainter and stronger pictures in which each feature keeps its share of saliency;\n"
                         "they are searched for first"))),
      m_allowed(named(new QCheckBox(tr("I &may share these voxels"), this), "shareAllowed",
                      tr("The page is written only when you have said so"))) {
    setObjectName("shareDialog");
    setWindowTitle(tr("Share as web page"));
    m_title->setPlaceholderText(QString::fromStdString(offered.settings.title));
    m_path->setMinimumWidth(360);
    for (const char* bits : settingOf(settingsOf<ShareSettings>(), "bits").choices) m_bits->addItem(tr(bits));
    m_density->setChecked(offered.settings.density == ShareDensity::On);
    auto* const browse = browseButton(*this);
    connect(browse, &QPushButton::clicked, this, &ShareDialog::browse);

    auto* const about = wrappedLabel("shareAbout", this);
    about->setText(tr("One HTML file that shows the volume in a browser, without a network: it can be turned, cut and "
                      "made fainter there, and features can be hidden."));
    makeFaint(*about);
    auto* const privacy = wrappedLabel("sharePrivacy", this);
    privacy->setText(
        tr("The page holds the voxels themselves, so whoever gets it has the data. No names, dates or other "
           "texts of DICOM go into it, but a head can be recognized by its face."));
    auto* const form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(about);
    form->addRow(tr("&Title"), m_title);
    form->addRow(tr("&Size"), m_size);
    form->addRow(tr("&Bits"), m_bits);
    form->addRow(QString(), m_density);
    addRow(*form, tr("&File"), m_path, rowOf({{m_path, 1}, browse}));
    form->addRow(privacy);
    form->addRow(m_allowed);
    auto* const buttons = closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel);
    m_save = buttons->button(QDialogButtonBox::Save);
    form->addRow(buttons);

    connect(m_bits, &QComboBox::currentIndexChanged, this, &ShareDialog::fillSizes);
    connect(m_allowed, &QCheckBox::toggled, this, &ShareDialog::follow);
    connect(m_path, &QLineEdit::textChanged, this, &ShareDialog::follow);
    fillSizes();
    follow();
}

void ShareDialog::fillSizes() {
    ShareSettings settings = options().settings;
    if (m_size->count() == 0) settings.voxels = ShareSettings{}.voxels;
    const int wanted = m_estimate(settings).factor;
    m_size->clear();
    int last = 0;
    for (const int voxels : kSizes) {
        settings.voxels = voxels;
        const ShareEstimate size = m_estimate(settings);
        if (size.factor == last) continue; // a smaller limit that changes nothing
        last = size.factor;
        m_size->addItem(textOf(size), voxels);
        if (size.factor == wanted) m_size->setCurrentIndex(m_size->count() - 1);
    }
}

void ShareDialog::browse() {
    const QString chosen =
        QFileDialog::getSaveFileName(this, tr("Share as web page"), m_path->text(), tr("Web pages (*.html)"), nullptr,
                                     QFileDialog::DontConfirmOverwrite);
    if (!chosen.isEmpty()) m_path->setText(chosen);
}

void ShareDialog::follow() { m_save->setEnabled(m_allowed->isChecked() && !m_path->text().trimmed().isEmpty()); }

ShareOptions ShareDialog::options() const {
    ShareOptions options;
    if (m_size->count() > 0) options.settings.voxels = m_size->currentData().toInt();
    options.settings.bits = static_cast<ShareBits>(m_bits->currentIndex());
    options.settings.density = m_density->isChecked() ? ShareDensity::On : ShareDensity::Off;
    options.settings.title = m_title->text().trimmed().toStdString();
    options.path = m_path->text().trimmed();
    if (!options.path.isEmpty() && !options.path.endsWith(".html") && !options.path.endsWith(".htm"))
        options.path += ".html";
    return options;
}

} // namespace pellucid::gui
