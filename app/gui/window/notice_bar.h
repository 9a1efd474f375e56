// Remarks about what is open, above the picture, until dismissed.
#pragma once

#include <QFrame>

#include "services/notices.h"

class QLabel;
class QVBoxLayout;

namespace pellucid::gui {

class NoticeBar : public QFrame {
    Q_OBJECT
public:
    explicit NoticeBar(Notices& notices, QWidget* parent = nullptr);

private:
    void refresh();

    Notices& m_notices;
    QLabel* m_label;     // the notices that nothing can be done about, and the texts of all
    QVBoxLayout* m_rows; // the others, each with its buttons
};

} // namespace pellucid::gui
