// How the bytes of a file without a header are to be read.
#pragma once

#include <QDialog>

#include "volume/loader.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace pellucid::gui {

/// What the file's name and size say about its layout: "41x41x41" and a type's name in the name, else a cube of bytes.
RawLayout guessRawLayout(const QString& path, qint64 bytes);

/// Whether a path names a file that has no header we know: .raw, .dat, .bin, .vol
bool isHeaderless(const QString& path);

class RawDialog : public QDialog {
    Q_OBJECT
public:
    explicit RawDialog(const QString& path, QWidget* parent = nullptr);
    RawLayout layoutOfFile() const;

private:
    void check();

    qint64 m_bytes;
    QSpinBox* m_dims[3];
    QDoubleSpinBox* m_spacing[3];
    QComboBox *m_type, *m_endian;
    QDoubleSpinBox* m_skip; // a QSpinBox ends at 2 GiB
    QLabel* m_verdict;
    QPushButton* m_ok;
};

} // namespace pellucid::gui
