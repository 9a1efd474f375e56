// What the window calls the figures: in plain words, or by the names of the literature where the user wants these.
#pragma once

#include <QObject>
#include <QString>

namespace pellucid::gui {

/// One for the program, as the theme is. Who shows a term that stays reads it again at changed().
class Terms : public QObject {
    Q_OBJECT
public:
    static Terms& instance();

    bool areScientific() const { return m_chosen || m_published; }
    /// The user's choice, which is kept on this machine.
    bool areChosen() const { return m_chosen; }
    void choose(bool scientific);
    /// Whether a session has the published profile, whose figures have these names alone.
    void setPublished(bool published);

    QString attention() const;       ///< "Attention", "VWS"
    QString visibility() const;      ///< "Seen", "Visibility"
    QString pictureSaliency() const; ///< "In the picture", "2DFS"
    QString distance() const;        ///< "Off target", "F"
    /// Of a distance from the targets, [0,1]: "off target by 2.2 %", "F = 0.0221".
    QString offTarget(double objective) const;
    /// In a column or legend of its own: "2.2 %", "0.0221".
    QString distanceText(double objective) const;

Q_SIGNALS:
    void changed();

private:
    Terms();
    void set(bool& which, bool value);

    bool m_chosen = false, m_published = false;
};

inline Terms& terms() { return Terms::instance(); }

} // namespace pellucid::gui
