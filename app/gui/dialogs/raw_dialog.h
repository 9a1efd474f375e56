// How the bytes of files without a header are to be read.
#pragma once

#include <optional>

#include <QDialog>
#include <QImage>
#include <QStringList>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "volume/raw_guess.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QSpinBox;

namespace pellucid::gui {

class SpacingFields;

/// Begins with the layout in the file's name; guesses by the voxels follow, and a picture of what is chosen. For one
/// file, or for all of a series, which are laid out alike.
class RawDialog : public QDialog {
    Q_OBJECT
public:
    /// `paths` are not empty.
    explicit RawDialog(const QStringList& paths, QWidget* parent = nullptr);
    RawLayout layoutOfFile() const;
    std::optional<GridSpacing> spacing() const; ///< empty: 1 along each axis, of no unit
    std::optional<double> missing() const;      ///< value of voxels without data

private:
    void lookAtSizes(const QStringList& paths);
    QString headOf(const QStringList& paths) const; ///< what is opened, as rich text
    void check();
    void setLayoutOfFile(const RawLayout& layout);
    void takeLook(const RawLook& look);
    static QImage pictureOf(const VolumeSource& source, const JobControl& job);

    QString m_path;
    qint64 m_bytes;                               // of a file, as most have it; unpacked as soon as that is known
    QStringList m_odd;                            // names of files of another size
    bool m_isPacked = false, m_isTouched = false; // by gzip, unpacking has not ended; by the user
    QSpinBox* m_dims[3];
    SpacingFields* m_spacing;
    QComboBox *m_type, *m_endian;
    QDoubleSpinBox* m_skip; // a QSpinBox ends at 2 GiB
    QLineEdit* m_missing;
    QLabel *m_verdict, *m_picture;
    QComboBox* m_guesses;
    QPushButton* m_ok;
    std::vector<RawLayout> m_layouts; // of m_guesses
    Job<QString, RawLook> m_look;
    Job<VolumeSource, QImage> m_pictures;
    RestTimer m_rest;
};

} // namespace pellucid::gui
