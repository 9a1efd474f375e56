// The probe of the window: what the ray through a clicked point meets, and more or less of what is there.
#pragma once

#include <optional>

#include <QObject>
#include <QPointF>
#include <QSizeF>

#include "render/probe.h"
#include "session/scene.h"

namespace pellucid::gui {

class Services;

/// Keeps a point of the volume, and follows the ray of the present camera through it, so that it always describes the
/// pixel in which the point appears, whatever is edited or turned. Ends when other data are opened.
class ProbeController : public QObject {
    Q_OBJECT
public:
    explicit ProbeController(Services& services);
    void addActions();

    /// Probes the pixel under `point` of a view of `size`, both logical; clears where nothing is visible there. The
    /// feature that adds most becomes the selected one, and the slices that are shown meet where it does.
    void probeAt(const QPointF& point, const QSizeF& size, double pixelsPerPoint);
    void clear();
    bool isActive() const { return m_ray.has_value(); }

    // Where it is active:
    const RayProbe& ray() const { return *m_ray; }
    const TransferFunction& tf() const { return m_tf; } ///< as the picture has it
    const Vec3& place() const { return m_place; }       ///< world
    std::optional<double> valueAtPlace() const;         ///< data units; empty where voxels are invalid
    /// The feature that "this" is: the selected one where the ray meets it, else that of the largest share; −1: none.
    int feature() const;

    bool canEmphasize() const;
    /// One step of the history: more or less of feature(), so much that its share of the pixel visibly changes; the
    /// status line says what was done, or why nothing was.
    void emphasize(bool more);

Q_SIGNALS:
    void changed();

private:
    void follow(const Scene& before, const Scene& after);
    /// The ray of the scene's camera through the place; empty where it is not in front of the camera.
    std::optional<RayProbe> rayOf(const TransferFunction& shown) const;

    Services& m_services;
    Vec3 m_place{0};
    int m_width = 1, m_height = 1; ///< of the picture when it was clicked on, pixels
    TransferFunction m_tf;
    std::optional<RayProbe> m_ray;
};

} // namespace pellucid::gui
