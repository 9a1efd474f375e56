#include "ghost_layer.h"

#include <QPainter>
#include <QPainterPath>

#include "controllers/refine_controller.h"
#include "theme.h"
#include "workbench.h"

namespace pellucid::gui {
namespace {

constexpr int kPieces = 16; // of an edge: a straight line of α is curved on an axis that is not linear

class GhostLayer : public CanvasLayer {
public:
    explicit GhostLayer(Workbench& bench) : m_bench(bench) {}

    void paint(QPainter& painter, const CanvasGeometry& where) override {
        const Refinement* refinement = m_bench.refining().latest();
        if (refinement == nullptr || !m_bench.refining().isGhostShown()) return;
        const std::vector<ControlPoint> points = refinement->before.pointsWithEnds();
        QPainterPath line(where.positionOf(points.front().x, points.front().opacity));
        for (std::size_t i = 1; i < points.size(); ++i) {
            const ControlPoint &a = points[i - 1], &b = points[i];
            for (int k = b.x > a.x ? 1 : kPieces; k <= kPieces; ++k) {
                const double t = static_cast<double>(k) / kPieces;
                line.lineTo(where.positionOf(a.x + t * (b.x - a.x), a.opacity + t * (b.opacity - a.opacity)));
            }
        }
        painter.save();
        painter.setClipRect(where.plot().adjusted(-1, -1, 1, 1));
        painter.setBrush(Qt::NoBrush);
        QPen pen(theme::kFaint, 1.2);
        pen.setDashPattern({4, 3});
        painter.setPen(pen);
        painter.drawPath(line);
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
