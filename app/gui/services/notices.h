// Remarks to the user about what is open, each with what can be done about it.
#pragma once

#include <functional>
#include <vector>

#include <QObject>
#include <QString>

namespace pellucid::gui {

struct Notice {
    QString text;
    struct Choice {
        QString text;
        std::function<void()> act; ///< the notice goes first
    };
    std::vector<Choice> choices = {};
};

/// The list that the notice bar shows; anybody may add to it.
class Notices : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    const std::vector<Notice>& all() const { return m_all; }
    void add(Notice notice); ///< one whose text is shown already is not repeated
    void remove(const QString& text);
    void clear();

Q_SIGNALS:
    void changed();

private:
    std::vector<Notice> m_all;
};

} // namespace pellucid::gui
