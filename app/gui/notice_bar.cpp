#include "notice_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

namespace pellucid::gui {

NoticeBar::NoticeBar(QWidget* parent) : QFrame(parent), m_label(new QLabel(this)) {
    setObjectName("noticeBar");
    m_label->setObjectName("noticeText");
    m_label->setWordWrap(true);
    m_label->setTextFormat(Qt::PlainText);
    m_label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    auto* close = new QToolButton(this);
    close->setObjectName("noticeClose");
    close->setText(QString(QChar(0x2715)));
    close->setAutoRaise(true);
    close->setToolTip(tr("Dismiss"));
    connect(close, &QToolButton::clicked, this, [this] { setNotices({}); });
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(12, 5, 6, 5);
    row->addWidget(m_label, 1);
    row->addWidget(close, 0, Qt::AlignTop);
    hide();
}

void NoticeBar::setNotices(const QStringList& notices) {
    m_notices = notices;
    m_label->setText(notices.join('\n'));
    setVisible(!notices.isEmpty());
}

void NoticeBar::addNotice(const QString& notice) { setNotices(m_notices + QStringList{notice}); }

} // namespace pellucid::gui
