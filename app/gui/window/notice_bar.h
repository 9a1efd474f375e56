// Remarks about what is open, over the lower edge of the picture, until dismissed.
#pragma once

#include <QFrame>

#include "services/notices.h"

class QLabel;
class QVBoxLayout;

namespace pellucid::gui {

/// Lies over its parent, which keeps its size: a picture is not drawn anew because there is something to say.
class NoticeBar : public QFrame {
    Q_OBJECT
public:
    explicit NoticeBar(Notices& notices, QWidget* parent);

protected:
    bool event(QEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void refresh();
    void place();

    Notices& m_notices;
    QLabel* m_label;     // the notices that nothing can be done about, and the texts of all
    QVBoxLayout* m_rows; // the others, each with its buttons
};

} // namespace pellucid::gui
