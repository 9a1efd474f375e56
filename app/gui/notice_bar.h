// Remarks about the open volume, above the picture, until dismissed.
#pragma once

#include <QFrame>
#include <QStringList>

class QLabel;

namespace pellucid::gui {

class NoticeBar : public QFrame {
    Q_OBJECT
public:
    explicit NoticeBar(QWidget* parent = nullptr);
    /// Replaces what is shown; hidden where there is nothing to say.
    void setNotices(const QStringList& notices);
    void addNotice(const QString& notice);
    const QStringList& notices() const { return m_notices; }

private:
    QLabel* m_label;
    QStringList m_notices;
};

} // namespace pellucid::gui
