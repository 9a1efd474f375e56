// For which program a transfer function is written, what that loses, and where it goes.
#pragma once

#include <functional>

#include <QDialog>

#include "tf/formats/tf_format.h"

class QComboBox;
class QLabel;
class QLineEdit;

namespace pellucid::gui {

struct ExportTfOptions {
    const TfFormat* format = nullptr;
    QString path;
};

class ExportTfDialog : public QDialog {
    Q_OBJECT
public:
    /// `path`: without a suffix. `losses`: what writing for a format would lose.
    ExportTfDialog(const QString& path, std::function<QStringList(const TfFormat&)> losses, QWidget* parent = nullptr);
    ExportTfOptions options() const;

private:
    const TfFormat& format() const;
    void showFormat(); ///< its suffix and what it loses

    std::function<QStringList(const TfFormat&)> m_losses;
    QComboBox* m_format;
    QLineEdit* m_path;
    QLabel* m_lost;
    QString m_suffix; ///< of the path
};

} // namespace pellucid::gui
