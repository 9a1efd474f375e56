#include "dialogs/save_volume_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "base/text.h"
#include "dialogs/closing_buttons.h"
#include "volume/excerpt.h"
#include "widgets/layouts.h"
#include "widgets/named.h"

namespace pellucid::gui {

namespace {

QString sizeText(const Int3& dims) { return QStringLiteral("%1 × %2 × %3").arg(dims.x).arg(dims.y).arg(dims.z); }

} // namespace

QString savedVolumeFilters() {
    QStringList filters;
    for (const auto& [format, pattern] : writtenVolumePatterns())
        filters << QStringLiteral("%1 (%2)").arg(QString::fromStdString(format), QString::fromStdString(pattern));
    return filters.join(";;");
}

SaveVolumeDialog::SaveVolumeDialog(const QString& path, const SavableVolume& there, QWidget* parent)
    : QDialog(parent), m_there(there), m_path(named(new QLineEdit(path, this), "volumePath",
                                                    tr("Where the volume goes; the suffix says in which format"))),
      m_what(named(new QComboBox(this), "volumeWhat", tr("The data as they were opened, or the field that is drawn"))),
      m_frames(named(new QComboBox(this), "volumeFrames",
                     tr("All frames go into one file, with their times. As VTK image data each gets a file of its own, "
                        "and a collection (.pvd) names them."))),
      m_coarser(named(new QComboBox(this), "volumeCoarser",
                      tr("Each voxel of a coarser copy is the mean of those that it stands for"))),
      m_type(named(new QComboBox(this), "volumeType",
                   tr("Type of the samples in the file. What it rounds or cuts off is said afterwards."))),
      m_clipped(named(new QCheckBox(this), "volumeClipped", tr("Leaves out the slices that the clip box cuts away"))),
      m_summary(named(new QLabel(this), "volumeSummary")) {
    setObjectName("saveVolumeDialog");
    setWindowTitle(tr("Save volume"));
    m_path->setMinimumWidth(380);
    m_what->addItem(tr("Data"), false);
    if (!there.fieldName.isEmpty()) m_what->addItem(tr("Field: %1").arg(there.fieldName), true);
    m_frames->addItem(tr("This one: %1").arg(there.frameName), false);
    m_frames->addItem(tr("All %1").arg(there.frames), true);
    m_clipped->setText(
        there.clipped ? tr("Only what the &clip box leaves: %1").arg(sizeText(there.clipped->hi - there.clipped->lo))
                      : tr("Only what the &clip box leaves"));
    m_clipped->setEnabled(there.clipped.has_value());
    for (const int factor : {1, 2, 4, 8}) m_coarser->addItem(QString(), factor);
    m_type->addItem(QString(), -1);
    for (int type = 0; type <= static_cast<int>(SampleType::F64); ++type)
        m_type->addItem(QString::fromLatin1(name(static_cast<SampleType>(type))), type);

    auto* button = browseButton(*this);
    connect(button, &QPushButton::clicked, this, &SaveVolumeDialog::browse);
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    addRow(*form, tr("&File"), m_path, rowOf({{m_path, 1}, button}));
    form->addRow(tr("What"), m_what);
    form->addRow(tr("Frames"), m_frames);
    form->addRow(tr("Part"), m_clipped);
    form->addRow(tr("Resolution"), m_coarser);
    form->addRow(tr("Samples"), m_type);
    form->addRow(QString(), m_summary);
    form->addRow(closingButtons(*this, QDialogButtonBox::Save | QDialogButtonBox::Cancel));
    form->setRowVisible(m_frames, there.frames > 1);
    form->setRowVisible(m_what, m_what->count() > 1);

    for (QComboBox* box : {m_what, m_frames, m_coarser, m_type})
        connect(box, &QComboBox::currentIndexChanged, this, &SaveVolumeDialog::describe);
    connect(m_clipped, &QCheckBox::toggled, this, &SaveVolumeDialog::describe);
    describe();
}

void SaveVolumeDialog::browse() {
    QString filter;
    for (const QString& one : savedVolumeFilters().split(";;"))
        if (m_path->text().endsWith(one.section("(*", 1).chopped(1), Qt::CaseInsensitive)) filter = one;
    const QString chosen = QFileDialog::getSaveFileName(this, tr("Save volume"), m_path->text(), savedVolumeFilters(),
                                                        &filter, QFileDialog::DontConfirmOverwrite);
    if (chosen.isEmpty()) return;
    const bool hasSuffix = !QFileInfo(chosen).suffix().isEmpty();
    m_path->setText(hasSuffix ? chosen : chosen + filter.section("(*", 1).chopped(1));
}

Int3 SaveVolumeDialog::writtenDims() const {
    const SaveVolumeOptions wanted = options();
    const VoxelRegion region = wanted.part.region.value_or(VoxelRegion{Int3(0), m_there.dims});
    return planOf(region, m_there.dims, wanted.part.coarser).dims;
}

void SaveVolumeDialog::describe() {
    const bool isField = m_what->currentData().toBool();
    m_frames->setEnabled(!isField);
    m_type->setItemText(
        0, tr("As they are (%1)").arg(QString::fromLatin1(name(isField ? SampleType::F32 : m_there.type))));
    const VoxelRegion region = options().part.region.value_or(VoxelRegion{Int3(0), m_there.dims});
    const QString words[] = {tr("Full: %1"), tr("Half: %1"), tr("A quarter: %1"), tr("An eighth: %1")};
    for (int i = 0; i < m_coarser->count(); ++i)
        m_coarser->setItemText(
            i, words[i].arg(sizeText(planOf(region, m_there.dims, m_coarser->itemData(i).toInt()).dims)));
    const SaveVolumeOptions wanted = options();
    const SampleType type = wanted.part.type.value_or(isField ? SampleType::F32 : m_there.type);
    const int frames = wanted.allFrames ? m_there.frames : 1;
    const std::uint64_t bytes = voxelCount(writtenDims()) * bytesPerSample(type) * static_cast<std::uint64_t>(frames);
    m_summary->setText(
        tr("%1 voxels of %2, %3 before they are packed")
            .arg(frames > 1 ? tr("%1 frames of %2").arg(frames).arg(sizeText(writtenDims())) : sizeText(writtenDims()),
                 QString::fromLatin1(name(type)), QString::fromStdString(describeBytes(bytes))));
}

SaveVolumeOptions SaveVolumeDialog::options() const {
    SaveVolumeOptions options{m_path->text().trimmed()};
    options.isField = m_what->currentData().toBool();
    options.allFrames = !options.isField && m_frames->currentData().toBool();
    if (const int type = m_type->currentData().toInt(); type >= 0) options.part.type = static_cast<SampleType>(type);
    if (m_clipped->isChecked()) options.part.region = m_there.clipped;
    options.part.coarser = m_coarser->currentData().toInt();
    return options;
}

} // namespace pellucid::gui
