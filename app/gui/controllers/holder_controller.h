// What the window says of the board or holder that an object lies on.
#pragma once

#include <QObject>
#include <QString>

#include "store/known_holder.h"

namespace pellucid::gui {

class OpenController;
class Services;

/// One note, which says how the holder of a volume that has just been opened is drawn, and offers the other ways; it
/// follows undo and the clip panel as long as nobody closes it.
class HolderController : public QObject {
    Q_OBJECT
public:
    HolderController(Services& services, OpenController& opening);

private:
    void tell();
    bool isTold() const;
    void say();
    void draw(const QString& step, void (*change)(FaintRest& rest, const FaintRest& known));

    Services& m_services;
    KnownHolder m_known;
    QString m_said; ///< the text of the note; empty: there is none
};

} // namespace pellucid::gui
