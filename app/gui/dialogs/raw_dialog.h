// How the bytes of files without a header are to be read.
#pragma once

#include <optional>

#include <QDialog>
#include <QStringList>

#include "volume/loader.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QSpinBox;

namespace pellucid::gui {

/// What the file's name and size say about its layout: "41x41x41" and a type's name in the name, else a cube of bytes.
RawLayout guessRawLayout(const QString& path, qint64 bytes);

/// For one file, or for all of a series, which are laid out alike.
class RawDialog : public QDialog {
    Q_OBJECT
public:
    /// `paths` are not empty.
    explicit RawDialog(const QStringList& paths, QWidget* parent = nullptr);
    RawLayout layoutOfFile() const;
    std::optional<double> missing() const; ///< value of voxels without data

private:
    void lookAtSizes(const QStringList& paths);
    QString headOf(const QStringList& paths) const; ///< what is opened, as rich text
    void check();

    qint64 m_bytes;    // of a file, as most have it
    QStringList m_odd; // names of files of another size
    QSpinBox* m_dims[3];
    QDoubleSpinBox* m_spacing[3];
    QComboBox *m_type, *m_endian;
    QDoubleSpinBox* m_skip; // a QSpinBox ends at 2 GiB
    QLineEdit* m_missing;
    QLabel* m_verdict;
    QPushButton* m_ok;
};

} // namespace pellucid::gui
