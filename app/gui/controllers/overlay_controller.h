// A second volume over the first: chosen, shown, given a transfer function of its own, taken away.
#pragma once

#include <QObject>

#include "volume/loader.h"

namespace pellucid::gui {

class OpenController;
class Services;

class OverlayController : public QObject {
    Q_OBJECT
public:
    OverlayController(Services& services, OpenController& opening) : m_services(services), m_opening(opening) {}

    void addActions();

    bool hasAny() const; ///< the session has an overlay, shown or not
    /// Reads it in the background; an error shows a dialog and leaves everything as it is.
    void lay(const VolumeSource& source);
    void remove();
    void setShown(bool shown);
    /// In the place of threshold, top and colours. An error shows a dialog.
    void openCurve(const QString& path);
    void removeCurve();

    void choose(); ///< asks for the file of the overlay
    void chooseCurve();

private:
    Services& m_services;
    OpenController& m_opening;
};

} // namespace pellucid::gui
