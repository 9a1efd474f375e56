// What widgets that paint themselves tell those who hear the window instead of seeing it.
#pragma once

#include <functional>
#include <optional>

#include <QAccessible>
#include <QString>

class QWidget;

namespace pellucid::gui {

/// The number that the keys of a widget change.
struct SpokenNumber {
    double now = 0, least = 0, most = 1, step = 0.01;
    std::function<void(double)> set = {}; ///< from `least` to `most`; empty: nothing sets it from outside
};

/// A widget that paints itself derives from it, after QWidget. Screen readers get the words as the widget's value, and
/// as its description, too: on Linux nothing but numbers reaches them as values. Once something else has been painted,
/// and a moment has gone by, they hear that it has changed.
class Spoken {
public:
    virtual QString spokenValue() const = 0; ///< what is shown and what is selected, without a full stop; never empty
    virtual std::optional<SpokenNumber> spokenNumber() { return {}; }

protected:
    Spoken(QWidget& self, QAccessible::Role role);
    ~Spoken() = default;
    void speakLater(); ///< for what is not painted by the widget itself

private:
    class Watch;
    static QAccessibleInterface* interfaceOf(const QString& className, QObject* object);

    QAccessible::Role m_role;
    Watch* m_watch; ///< a child of the widget
};

} // namespace pellucid::gui
