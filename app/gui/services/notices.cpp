#include "services/notices.h"

#include <algorithm>

#include "widgets/sentence.h"

namespace pellucid::gui {

void Notices::add(Notice notice) {
    notice.text = asSentence(notice.text);
    const bool known = std::any_of(m_all.begin(), m_all.end(), [&](const Notice& n) { return n.text == notice.text; });
    if (known) return;
    m_all.push_back(std::move(notice));
    Q_EMIT changed();
}

void Notices::remove(const QString& text) {
    if (std::erase_if(m_all, [said = asSentence(text)](const Notice& n) { return n.text == said; }) > 0)
        Q_EMIT changed();
}

void Notices::clear() {
    if (m_all.empty()) return;
    m_all.clear();
    Q_EMIT changed();
}

} // namespace pellucid::gui
