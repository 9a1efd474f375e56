#include "view/compared_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include "controllers/comparison_controller.h"
#include "jobs/rest_timer.h"
#include "view/annotation_layer.h"
#include "view/cpu_surface.h"
#include "view/gl_surface.h"
#include "view/volume_view.h"
#include "widgets/shown_vision.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

QString nameOfB(const ComparisonController& comparing) {
    return ComparedView::tr("B: %1").arg(QString::fromStdString(comparing.view().b->name));
}

} // namespace

void paintSideName(QPainter& painter, const QRectF& area, const QString& name) {
    constexpr double kMargin = 8, kInset = 7;
    const QFontMetricsF metrics(painter.font());
    const double most = area.width() - 2 * (kMargin + kInset);
    if (most < metrics.averageCharWidth() * 2) return;
    const QString text = metrics.elidedText(name, Qt::ElideRight, most);
    QRectF box(0, area.top() + kMargin, metrics.horizontalAdvance(text) + 2 * kInset, metrics.height() + 4);
    box.moveLeft(area.center().x() - box.width() / 2);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(0, 0, 0, 150));
    painter.drawRoundedRect(box, 4, 4);
    painter.setPen(theme::kMark);
    painter.drawText(box, Qt::AlignCenter, text);
}

/// Over the picture: what stands around it, and its name.
class ComparedView::Overlay : public QWidget {
public:
    Overlay(ComparisonController& comparing, QWidget* parent) : QWidget(parent), m_comparing(comparing) {
        setObjectName("comparedOverlay");
        setAttribute(Qt::WA_TransparentForMouseEvents);
        setAttribute(Qt::WA_NoSystemBackground);
        followShownVision(*this);
    }
    QRect seen; ///< of it

protected:
    void paintEvent(QPaintEvent*) override {
        const Scene* const scene = m_comparing.sceneB();
        if (scene == nullptr || !m_comparing.hasB()) return;
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        m_annotations.paint(painter, {*scene, QSizeF(size())});
        paintSideName(painter, seen, nameOfB(m_comparing));
    }

private:
    ComparisonController& m_comparing;
    AnnotationLayer m_annotations;
};

ComparedView::ComparedView(ComparisonController& comparing, VolumeView& viewOfA, QWidget* parent)
    : QWidget(parent), Spoken(*this, QAccessible::Graphic), m_comparing(comparing), m_viewOfA(viewOfA),
      m_hand(
          *this, [&comparing] { return comparing.sceneB(); },
          [&comparing](const Camera& camera, int gesture) { comparing.turnB(camera, gesture); }),
      m_overlay(new Overlay(comparing, this)) {
    setObjectName("comparedView");
    setAccessibleName(tr("What is compared with"));
    setWhatsThis(tr("The picture of state B, from the same view or its own."));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    hide();
    connect(&comparing, &ComparisonController::sceneChanged, this, &ComparedView::follow);
    connect(&viewOfA, &VolumeView::pictureShown, this, &ComparedView::follow); // it may draw by something else now
}

ComparedView::~ComparedView() {
    if (!m_surface) return;
    m_surface->onPicture = nullptr;
    m_surface->onFailure = nullptr;
}

void ComparedView::place(const QRect& picture, const QRect& seen) {
    setGeometry(seen);
    m_picture = picture.translated(-seen.topLeft());
    m_overlay->seen = QRect(seen.topLeft() - picture.topLeft(), seen.size());
    m_overlay->setGeometry(m_picture);
    m_overlay->update();
    if (m_surface) m_surface->widget()->setGeometry(m_picture);
}

void ComparedView::setShown(bool shown) {
    setVisible(shown);
    if (!shown) {
        m_surface.reset(); // with what it holds of the volume
        m_failed = false;
        return;
    }
    follow();
}

void ComparedView::makeSurface() {
    m_drawsByGl = m_viewOfA.drawsByGl() && !m_failed;
    if (m_drawsByGl)
        m_surface = std::make_unique<GlSurface>(this);
    else
        m_surface = std::make_unique<CpuSurface>(this);
    QWidget& widget = *m_surface->widget();
    widget.setFocusPolicy(Qt::NoFocus);
    widget.setAttribute(Qt::WA_TransparentForMouseEvents);
    widget.setGeometry(m_picture);
    widget.show();
    m_overlay->raise();
    m_surface->onPicture = [this] { Q_EMIT pictureShown(); };
    m_surface->onFailure = [this](const Error&) {
        later(this, [this] { // the one that failed is still on the stack
            const bool gl = m_drawsByGl;
            m_failed = true;
            if (gl) makeSurface();
            follow();
        });
    };
}

void ComparedView::follow() {
    const Scene* const scene = m_comparing.sceneB();
    if (isHidden() || scene == nullptr) return;
    if (!m_surface || m_drawsByGl != (m_viewOfA.drawsByGl() && !m_failed)) makeSurface();
    m_surface->setScene(pictureInput(*scene, 1, 1));
    m_overlay->update();
    speakLater();
}

QString ComparedView::spokenValue() const {
    const Scene* const scene = m_comparing.sceneB();
    if (scene == nullptr || !m_comparing.hasB()) return tr("Nothing is compared");
    return tr("%1, %2").arg(nameOfB(m_comparing), viewText(scene->camera, scene->volume->geometry()));
}

void ComparedView::mousePressEvent(QMouseEvent* event) {
    if (m_hand.isHolding()) return;
    if (!m_hand.press(*event)) event->ignore();
}

void ComparedView::mouseMoveEvent(QMouseEvent* event) { m_hand.move(*event); }

void ComparedView::mouseReleaseEvent(QMouseEvent* event) { m_hand.release(*event); }

void ComparedView::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) m_hand.fit();
}

void ComparedView::wheelEvent(QWheelEvent* event) { m_hand.wheel(*event); }

void ComparedView::keyPressEvent(QKeyEvent* event) {
    if (!m_hand.key(event->key())) QWidget::keyPressEvent(event);
}

} // namespace pellucid::gui
