// What of a volume is saved, as what, and where.
#pragma once

#include <optional>

#include <QDialog>
#include <QString>

#include "volume/volume_writer.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QLineEdit;

namespace pellucid::gui {

struct SaveVolumeOptions {
    QString path;
    bool isField = false;   ///< the field that is drawn, in place of the data
    bool allFrames = false; ///< of the data
    WrittenPart part{};
};

/// What there is to be saved.
struct SavableVolume {
    Int3 dims{1, 1, 1};
    SampleType type = SampleType::U8;
    int frames = 1;
    QString frameName{};                  ///< of the one that is shown
    QString fieldName{};                  ///< of the field that is drawn; empty: none is
    std::optional<VoxelRegion> clipped{}; ///< what the clip box leaves; empty: it leaves all
};

/// The formats that volumes are written in, for file dialogs: "NRRD (*.nrrd);;MetaImage (*.mha);;…".
QString savedVolumeFilters();

class SaveVolumeDialog : public QDialog {
    Q_OBJECT
public:
    /// `path` is offered.
    SaveVolumeDialog(const QString& path, const SavableVolume& there, QWidget* parent = nullptr);
    SaveVolumeOptions options() const;

private:
    void browse();
    /// What will be written, with its size.
    void describe();
    Int3 writtenDims() const;

    SavableVolume m_there;
    QLineEdit* m_path;
    QComboBox *m_what, *m_frames, *m_coarser, *m_type;
    QCheckBox* m_clipped;
    QLabel* m_summary;
};

} // namespace pellucid::gui
