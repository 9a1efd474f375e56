#include "tf/ghost_layer.h"

#include <QPainter>

#include "controllers/refine_controller.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

class GhostLayer : public CanvasLayer {
public:
    explicit GhostLayer(RefineController& refining) : m_refining(refining) {}

    void paint(QPainter& painter, const CanvasGeometry& where) override {
        const Refinement* refinement = m_refining.latest();
        if (refinement == nullptr || !m_refining.isGhostShown()) return;
        painter.save();
        painter.setClipRect(where.plot().adjusted(-1, -1, 1, 1));
        painter.setBrush(Qt::NoBrush);
        QPen pen(theme::kFaint, 1.2);
        pen.setDashPattern({4, 3});
        painter.setPen(pen);
        painter.drawPath(where.curveOf(refinement->before));
        painter.restore();
    }

private:
    RefineController& m_refining;
};

} // namespace

void addGhostLayer(RefineController& refining, TfCanvas& canvas) {
    canvas.addLayer(std::make_unique<GhostLayer>(refining));
    QObject::connect(&refining, &RefineController::refined, &canvas, qOverload<>(&QWidget::update));
    QObject::connect(&refining, &RefineController::ghostChanged, &canvas, qOverload<>(&QWidget::update));
}

} // namespace pellucid::gui
