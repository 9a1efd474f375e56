// How the data lie in the world: turned, mirrored, or said by the user where their file does not.
#pragma once

#include <QObject>

#include "volume/grid_axes.h"

namespace pellucid::gui {

class OpenController;
class Services;

class OrientationController : public QObject {
    Q_OBJECT
public:
    OrientationController(Services& services, OpenController& opening);

    void addActions();
    /// Asks how the axes run.
    void choose();

private:
    GridAxes now() const;
    /// A quarter turn about a direction of the world, or about the axis nearest to it, the way a screw goes in.
    void turn(const QString& text, const Vec3& about);
    void mirror(const Vec3& along);
    void tell(); ///< as long as the data do not lie as the file says
    void set(const QString& text, const std::optional<GridAxes>& axes); ///< empty: as the file says

    Services& m_services;
    OpenController& m_opening;
    QString m_told; ///< the notice that is shown
};

} // namespace pellucid::gui
