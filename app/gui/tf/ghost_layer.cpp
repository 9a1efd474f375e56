#include "tf/ghost_layer.h"

#include <QPainter>
#include <QPainterPath>

#include "controllers/refine_controller.h"
#include "services/workbench.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

class GhostLayer : public CanvasLayer {
public:
    explicit GhostLayer(Workbench& bench) : m_bench(bench) {}

    void paint(QPainter& painter, const CanvasGeometry& where) override {
        const Refinement* refinement = m_bench.refining().latest();
        if (refinement == nullptr || !m_bench.refining().isGhostShown()) return;
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
    Workbench& m_bench;
};

} // namespace

void addGhostLayer(Workbench& bench, TfCanvas& canvas) {
    canvas.addLayer(std::make_unique<GhostLayer>(bench));
    QObject::connect(&bench.refining(), &RefineController::refined, &canvas, qOverload<>(&QWidget::update));
    QObject::connect(&bench.refining(), &RefineController::ghostChanged, &canvas, qOverload<>(&QWidget::update));
}

} // namespace pellucid::gui
