// How the data lie in the world: turned, mirrored, or said by the user where their file does not; and how far their
// voxels are apart.
#pragma once

#include <optional>
#include <utility>

#include <QObject>

#include "volume/grid_axes.h"

namespace pellucid {
struct Scene;
struct VolumeSource;
} // namespace pellucid

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
    /// Asks how far voxels are apart.
    void chooseSpacing();

private:
    GridAxes now() const;
    /// A quarter turn about a direction of the world, or about the axis nearest to it, the way a screw goes in.
    void turn(const QString& text, const Vec3& about);
    void mirror(const Vec3& along);
    void tell(); ///< as long as the data do not lie as the file says
    void noteSpacing(const Scene& before, const Scene& after);
    /// After a step, undone or done: the camera keeps its place relative to data whose voxels are farther apart now.
    void follow();
    const VolumeSource& source() const;
    void set(const QString& text, const std::optional<GridAxes>& axes); ///< empty: as the file says
    void setSpacing(const QString& text, const std::optional<GridSpacing>& spacing);
    void place(const QString& text, const std::optional<GridAxes>& axes, const std::optional<GridSpacing>& spacing);

    Services& m_services;
    OpenController& m_opening;
    QString m_told;                                        ///< the notice that is shown
    std::optional<std::pair<Geometry, Geometry>> m_spaced; ///< before and after a step that may be one
};

} // namespace pellucid::gui
