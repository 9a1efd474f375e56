// A slider that makes the picture stronger or fainter, at equal shares.
#pragma once

#include <optional>

#include <QWidget>

#include "jobs/job.h"
#include "jobs/rest_timer.h"
#include "optimize/answer/density_curve.h"
#include "session/scene.h"

class QLabel;
class QSlider;
class QToolButton;

namespace pellucid::gui {

class Services;

/// Moves along the curve of equal shares (optimize/answer/density_curve.h), from its faint end to its strong one. The
/// curve of the present shares is computed after an optimization, or when the slider is touched for the first time; it
/// is kept for as long as the scene lies on it. The slider's place is part of the session. While the slider is held the
/// picture follows; letting go is one undo step, and keys in a row are one. With the button beside it, it scales all
/// opacities alike: then the slider is in its middle at × 1 and goes back there.
class DensitySlider : public QWidget {
    Q_OBJECT
public:
    explicit DensitySlider(Services& services, QWidget* parent = nullptr);

    /// Along what it moves now; null: not known.
    const DensityCurve* curve() const { return m_curve ? &m_curve->curve : nullptr; }
    bool isComputing() const { return m_job.isRunning(); }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    /// What a curve was computed for.
    struct Request {
        MeasureInput input;
        TransferFunction tf; ///< with what is hidden of it
        std::vector<OpacityLimits> limits;
        bool operator==(const Request&) const = default;
    };
    struct Known {
        Request about;
        DensityCurve curve;
    };

    Request present() const;
    /// Coverage of the scene on the known curve; empty where it does not lie there.
    std::optional<double> placeOf(const Request& now) const;
    void compute();
    void take(const Request& request, DensityCurve& curve);
    void followScene();
    void follow();
    void followCurve();
    void followFactor();
    void release();
    void rest();
    void showCoverage(std::optional<double> coverage);
    bool scales() const;   ///< all opacities alike
    double factor() const; ///< [1/16, 16]
    double coverageAt(int value) const;
    double shareOf(double coverage) const; ///< of the way from the faint end of the curve to its strong one, [0,1]
    int valueOf(double coverage) const;

    Services& m_services;
    QSlider* m_slider; ///< per mille of the curve, even in ln coverage; or hundredths of doublings
    QLabel* m_value;
    QToolButton* m_all;
    std::optional<Known> m_curve;
    Job<Request, DensityCurve> m_job;
    RestTimer m_later;
    int m_offset = 0;        ///< of the curve from the mouse, where it came after the press
    bool m_givenUp = false;  ///< Escape was pressed while the mouse still holds the slider
    bool m_changing = false; ///< the scene, by this slider
};

} // namespace pellucid::gui
