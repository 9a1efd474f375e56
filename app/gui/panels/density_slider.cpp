#include "panels/density_slider.h"

#include <algorithm>
#include <cmath>

#include <QKeyEvent>
#include <QScopedValueRollback>
#include <QSignalBlocker>
#include <QSlider>

#include "optimize/answer/visibility_words.h"
#include "services/services.h"
#include "store/edits.h"
#include "tf/edit.h"
#include "tf/shown_tf.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

constexpr double kPerDoubling = 100;
constexpr int kReach = 1000;      // of the slider along the curve
constexpr int kSettleTime = 400;  // milliseconds after an optimization until its curve is computed
constexpr double kOnCurve = 0.03; // distance in ln τ

/// The same points but for rounding.
bool nearlySame(const TransferFunction& a, const TransferFunction& b) {
    if (a.features != b.features || a.points.size() != b.points.size() || a.range != b.range) return false;
    for (std::size_t i = 0; i < a.points.size(); ++i) {
        const ControlPoint &p = a.points[i], &q = b.points[i];
        if (p.x != q.x || !(p.color == q.color) || std::abs(p.opacity - q.opacity) > 1e-9) return false;
    }
    return true;
}

QString textOf(double share) { return QString::fromStdString(percentText(share)); }

} // namespace

DensitySlider::DensitySlider(Services& services, QWidget* parent)
    : QWidget(parent), m_services(services),
      m_slider(named(new QSlider(Qt::Horizontal, this), "densitySlider", tr("How solid the picture is, in % opaque"))),
      m_value(named(new QLabel(this), "densityValue")),
      m_all(named(toolButton(tr("Scale all"), this), "densityAll",
                  tr("Scale all opacities alike instead: the extinction times a factor; the shares change"))),
      m_job(
          [&workspace = services.workspace()](const Request& request, const JobControl& job) {
              return workspace.densityCurve(request.input, request.limits, {job.stop, {}});
          },
          [this](const Request& request, DensityCurve& curve) { take(request, curve); }, WhenBusy::StopOld,
          &services.compute()),
      m_later(kSettleTime, [this] { compute(); }) {
    setObjectName("densityRow");
    m_slider->setMinimumWidth(80);
    m_slider->setFocusPolicy(Qt::StrongFocus);
    m_slider->installEventFilter(this);
    m_value->setFixedWidth(m_value->fontMetrics().horizontalAdvance(QStringLiteral("× 00.00")) + 4);
    m_value->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    m_all->setCheckable(true);
    auto* label = new QLabel(tr("&Density"), this);
    label->setBuddy(m_slider);
    label->setToolTip(tr("How solid the picture is, in % opaque"));
    setLayout(inset(rowOf({label, {m_slider, 1}, m_value, m_all}, 6), {}));
    connect(m_slider, &QSlider::valueChanged, this, &DensitySlider::follow);
    connect(m_slider, &QSlider::sliderPressed, this, [this] {
        if (!scales()) compute();
    });
    connect(m_slider, &QSlider::sliderReleased, this, &DensitySlider::release);
    connect(m_all, &QToolButton::toggled, this, &DensitySlider::rest);
    connect(&m_job, &JobBase::busyChanged, this, &DensitySlider::rest);
    connect(&m_job, &JobBase::failed, this,
            [this](const Error& error) { m_services.showError(tr("The curve of equal shares"), error); });
    connect(&services, &Services::readOnlyChanged, this, [this] {
        if (m_services.isReadOnly()) {
            m_later.stop();
            m_job.cancel();
        } else {
            m_later.start();
        }
    });
    connect(&services.store(), &SessionStore::changed, this, &DensitySlider::followScene);
    connect(&services.results(), &Results::changed, this, [this] {
        if (!m_slider->isSliderDown()) rest();
    });
    rest();
}

DensitySlider::Request DensitySlider::present() const {
    const Scene& scene = m_services.scene();
    return {measureInput(scene), scene.tf, limitsOf(scene.tf, *scene.session.goals)};
}

std::optional<double> DensitySlider::placeOf(const Request& now) const {
    if (!m_curve) return {};
    const Request& about = m_curve->about;
    const MeasureInput &a = about.input, &b = now.input;
    if (a.volume != b.volume || !(a.view == b.view) || !(a.settings == b.settings) || about.limits != now.limits)
        return {};
    const std::vector<double> x = featureOpacities(now.input.tf);
    if (x.size() != about.tf.features.size() || !nearlySame(withShownOpacities(about.tf, x), now.tf)) return {};
    const DensityCurve::Nearest nearest = m_curve->curve.nearest(x);
    if (nearest.distance > kOnCurve && !(now.tf == about.tf)) return {};
    return nearest.coverage;
}

void DensitySlider::compute() {
    m_later.stop();
    if (m_job.isRunning() || !m_services.isEditable() || m_services.scene().tf.features.empty()) return;
    const Request now = present();
    if (placeOf(now)) return;
    m_curve.reset();
    m_job.start(now, tr("the curve of equal shares"));
}

void DensitySlider::take(const Request& request, DensityCurve& curve) {
    m_curve = Known{request, std::move(curve)};
    const std::optional<double> place = placeOf(present());
    if (place) {
        const QScopedValueRollback changing(m_changing, true);
        m_services.store().amend([at = shareOf(*place)](Session& session) { session.density = at; });
        // What the mouse holds is where the scene is, wherever it took the slider.
        if (m_slider->isSliderDown() && !scales()) m_offset = valueOf(*place) - m_slider->value();
    } else {
        m_curve.reset(); // the scene has gone on
    }
    rest();
}

void DensitySlider::followScene() {
    if (m_changing) return;
    if (m_job.isRunning() && !m_slider->isSliderDown()) m_job.cancel();
    if (m_curve && !placeOf(present())) m_curve.reset();
    rest();
}

bool DensitySlider::scales() const { return m_all->isChecked(); }
double DensitySlider::factor() const { return std::exp2(m_slider->value() / kPerDoubling); }

double DensitySlider::coverageAt(int value) const {
    const double low = m_curve->curve.faintest().coverage.coverage;
    const double high = m_curve->curve.strongest().coverage.coverage;
    return low * std::pow(high / low, std::clamp(value, 0, kReach) / static_cast<double>(kReach));
}

double DensitySlider::shareOf(double coverage) const {
    const double low = m_curve->curve.faintest().coverage.coverage;
    const double high = m_curve->curve.strongest().coverage.coverage;
    return high > low ? std::clamp(std::log(coverage / low) / std::log(high / low), 0.0, 1.0) : 1;
}

int DensitySlider::valueOf(double coverage) const { return static_cast<int>(std::lround(kReach * shareOf(coverage))); }

void DensitySlider::follow() {
    if (m_givenUp || !m_services.store().hasVolume()) return rest();
    if (scales())
        followFactor();
    else
        followCurve();
}

void DensitySlider::followFactor() {
    SessionStore& store = m_services.store();
    m_value->setText(QStringLiteral("× %1").arg(factor(), 0, 'f', 2));
    if (m_slider->isSliderDown()) {
        previewTf(store, withDensity(store.committed().tf, factor()), tr("Density"));
    } else {
        store.commit();
        editTf(store, withDensity(store.scene().tf, factor()), tr("Density"), QStringLiteral("density"));
        rest();
    }
}

void DensitySlider::followCurve() {
    if (!m_curve) return compute();
    const double coverage = coverageAt(m_slider->value() + m_offset);
    const auto change = [tf = withShownOpacities(m_curve->about.tf, m_curve->curve.at(coverage)),
                         at = shareOf(coverage)](Session& session) {
        session.setTf(tf);
        session.density = at;
    };
    const QScopedValueRollback changing(m_changing, true);
    if (m_slider->isSliderDown()) {
        m_services.store().preview(tr("Density"), change);
    } else {
        m_services.store().commit();
        m_services.store().edit(tr("Density"), QStringLiteral("density at equal shares"), change);
    }
    showCoverage(coverage);
}

void DensitySlider::release() {
    m_changing = true;
    m_services.store().commit();
    m_changing = false;
    m_offset = 0;
    rest();
}

void DensitySlider::showCoverage(std::optional<double> coverage) {
    m_value->setText(m_job.isRunning() ? tr("…") : coverage ? textOf(*coverage) : QStringLiteral("–"));
}

void DensitySlider::rest() {
    if (m_slider->isSliderDown() && !m_givenUp) {
        if (!scales() && !m_curve) showCoverage({});
        return;
    }
    const QSignalBlocker blocker(m_slider);
    QString tip;
    const Measures* const measures = m_services.results().measures();
    if (scales()) {
        const int reach = static_cast<int>(std::lround(std::log2(kMostDensity) * kPerDoubling));
        m_slider->setRange(-reach, reach);
        m_slider->setSingleStep(10);
        m_slider->setPageStep(100);
        m_slider->setValue(0);
        m_value->setText(QStringLiteral("× 1.00"));
        tip = tr("Multiplies the extinction: everything denser or thinner; the shares change, too.\n"
                 "Drag it, let go, drag again; Escape cancels a drag");
    } else {
        m_slider->setRange(0, kReach);
        m_slider->setSingleStep(20);
        m_slider->setPageStep(100);
        const std::optional<double> place = m_services.store().hasVolume() ? placeOf(present()) : std::nullopt;
        // Where nobody knows the way from here it stays where the session has left it.
        const double left = m_services.scene().session.density.value_or(0.5);
        m_slider->setValue(place ? valueOf(*place) : static_cast<int>(std::lround(kReach * left)));
        std::optional<double> coverage = place;
        if (measures && measures->coverage && m_services.results().measuresAreCurrent())
            coverage = measures->coverage->coverage;
        showCoverage(coverage);
        tip = tr("Stronger or fainter with the same shares of attention (VWS), from this camera.\n"
                 "Escape cancels a drag");
        if (m_job.isRunning())
            tip += tr("\nFinding the opacities of equal shares …");
        else if (m_curve && m_curve->curve.isPoint())
            tip += tr("\nLocks and limits leave only one picture with these shares");
        else if (m_curve)
            tip += tr("\nWith these shares: from %1 to %2 opaque, mean over the pixels whose rays meet a feature "
                      "that is drawn")
                       .arg(textOf(m_curve->curve.faintest().coverage.coverage),
                            textOf(m_curve->curve.strongest().coverage.coverage));
    }
    m_slider->setToolTip(tip);
    QString value =
        tr("How solid the picture is: mean opacity of the pixels that show a feature (coverage, mean alpha)");
    if (measures && measures->coverage && measures->coverage->covers.size() == m_services.scene().tf.features.size())
        for (std::size_t f = 0; f < measures->coverage->covers.size(); ++f)
            value += tr("\n%1: %2 opaque where it is seen")
                         .arg(QString::fromStdString(m_services.scene().tf.features[f].name),
                              textOf(measures->coverage->covers[f]));
    m_value->setToolTip(value);
}

bool DensitySlider::eventFilter(QObject* watched, QEvent* event) {
    // The wheel scrolls the panel; it must not change a picture in passing.
    if (event->type() == QEvent::Wheel && !m_slider->hasFocus()) {
        event->ignore();
        return true;
    }
    // A second click finds the slider where the first has left it, at × 1: it must not jump to the mouse.
    if (event->type() == QEvent::MouseButtonDblClick) return true;
    if (event->type() == QEvent::MouseButtonRelease) m_givenUp = false;
    if (event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape &&
        m_slider->isSliderDown()) {
        {
            const QSignalBlocker blocker(m_slider); // released, but not let go
            m_slider->setSliderDown(false);
        }
        m_givenUp = true;
        m_offset = 0;
        m_changing = true;
        m_services.store().cancel();
        m_changing = false;
        rest();
        return true;
    }
    return QWidget::eventFilter(watched, event);
}

} // namespace pellucid::gui
