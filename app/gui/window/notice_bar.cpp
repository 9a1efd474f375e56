#include "window/notice_bar.h"

#include <algorithm>

#include <QEvent>
#include <QHBoxLayout>
#include <QPushButton>

#include "widgets/controls.h"

namespace pellucid::gui {
namespace {

// Logical pixels.
constexpr int kMargin = 8, kLeastWidth = 480, kMostWidth = 720;
constexpr int kCorner = 100; // of the picture, where the cube and the scale stand
constexpr int kMarks = 44;   // above the lower edge: the scale and the letter of the direction below

} // namespace

NoticeBar::NoticeBar(Notices& notices, QWidget* parent)
    : QFrame(parent), m_notices(notices), m_label(wrappedLabel("noticeText", this)), m_rows(new QVBoxLayout) {
    setObjectName("noticeBar");
    m_label->setTextFormat(Qt::PlainText);
    m_label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    auto* close = named(toolButton(QChar(0x2715), this), "noticeClose", tr("Dismiss"));
    close->setAutoRaise(true);
    connect(close, &QToolButton::clicked, &m_notices, &Notices::clear);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(12, 4, 4, 4);
    row->addWidget(m_label, 1);
    row->addLayout(m_rows);
    row->addWidget(close, 0, Qt::AlignTop);
    connect(&notices, &Notices::changed, this, &NoticeBar::refresh);
    parent->installEventFilter(this);
    refresh();
}

bool NoticeBar::event(QEvent* event) {
    if (event->type() == QEvent::LayoutRequest) place();
    return QFrame::event(event);
}

bool NoticeBar::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Resize) place();
    return QFrame::eventFilter(watched, event);
}

void NoticeBar::place() {
    const int whole = parentWidget()->width() - 2 * kMargin;
    const int room = std::max(std::min(whole, kLeastWidth), whole - 2 * kCorner);
    // As wide as the longest line, as far as there is room.
    const int around = sizeHint().width() - m_label->sizeHint().width();
    int longest = 0;
    for (const QString& line : m_label->text().split('\n'))
        longest = std::max(longest, m_label->fontMetrics().horizontalAdvance(line) + 8);
    const int width = std::min({room, kMostWidth, around + longest});
    const int height = layout()->hasHeightForWidth() ? layout()->totalHeightForWidth(width) : sizeHint().height();
    setGeometry((parentWidget()->width() - width) / 2, parentWidget()->height() - height - kMarks, width, height);
    raise();
}

void NoticeBar::refresh() {
    QStringList texts;
    while (QLayoutItem* item = m_rows->takeAt(0)) {
        if (item->widget() != nullptr) item->widget()->deleteLater(); // it may be the button that was clicked
        delete item;
    }
    int number = 0;
    for (const Notice& notice : m_notices.all()) {
        texts << notice.text;
        for (const Notice::Choice& choice : notice.choices) {
            auto* button =
                named(new QPushButton(choice.text, this), QStringLiteral("noticeChoice%1").arg(number++), notice.text);
            connect(button, &QPushButton::clicked, &m_notices, [this, text = notice.text, act = choice.act] {
                m_notices.remove(text);
                act();
            });
            m_rows->addWidget(button);
        }
    }
    m_label->setText(texts.join('\n'));
    setVisible(!texts.isEmpty());
    place();
}

} // namespace pellucid::gui
