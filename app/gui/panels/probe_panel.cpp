#include "panels/probe_panel.h"

#include <algorithm>

#include <QFrame>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPushButton>
#include <QScrollArea>
#include <QWheelEvent>

#include "controllers/probe_controller.h"
#include "panels/probe_plot.h"
#include "render/clip_handles.h"
#include "services/services.h"
#include "view/volume_view.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kWidth = 320, kMargin = 10;
constexpr int kMostRowsHeight = 160; ///< of the shares, before they scroll

/// A ring around the place, in the colour of its feature.
class ProbeLayer : public OverlayLayer {
public:
    explicit ProbeLayer(ProbeController& probe) : m_probe(probe) {}

    void paint(QPainter& painter, const LayerView& view) override {
        if (!m_probe.isActive()) return;
        const auto at = pixelOf({view.scene.camera, std::max(1, static_cast<int>(view.size.width())),
                                 std::max(1, static_cast<int>(view.size.height()))},
                                m_probe.place());
        if (!at) return;
        const QPointF place(at->x, at->y);
        const int f = m_probe.feature();
        const QColor color =
            f >= 0 ? colorFromRgb(m_probe.tf().features[static_cast<std::size_t>(f)].color) : QColor(Qt::white);
        painter.setBrush(Qt::NoBrush);
        for (const QPen& pen : {QPen(QColor(0, 0, 0, 200), 5), QPen(Qt::white, 3), QPen(color, 1.5)}) {
            painter.setPen(pen);
            painter.drawEllipse(place, 7, 7);
        }
    }

private:
    ProbeController& m_probe;
};

/// Lies over the view while the probe is active, in a corner away from the click; it can be dragged elsewhere.
class ProbePanel : public QFrame {
public:
    ProbePanel(Services& services, ProbeController& probe, VolumeView& view);

protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override { event->accept(); }
    void keyPressEvent(QKeyEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void refresh();
    void refreshText();
    void keepInView();

    Services& m_services;
    ProbeController& m_probe;
    VolumeView& m_view;
    QLabel* m_title = wrappedLabel("probeTitle", this);
    QLabel* m_readout = wrappedLabel("probeReadout", this);
    QLabel* m_text = wrappedLabel("probeText", this);
    QLabel* m_hint = wrappedLabel("probeHint", this);
    ProbePlot* m_plot = new ProbePlot(m_services, m_probe, this);
    ProbeShares* m_shares = new ProbeShares(m_services, m_probe, this);
    QScrollArea* m_scroll = new QScrollArea(this);
    QPushButton* m_more = named(new QPushButton(tr("More of this"), this), "moreOfThisButton",
                                tr("Raise the opacity of this feature, and lower that of what hides it here (Ctrl+]).\n"
                                   "Locked features and fixed points stay."));
    QPushButton* m_less = named(new QPushButton(tr("Less of this"), this), "lessOfThisButton",
                                tr("Lower the opacity of this feature, and raise that of what hides it here (Ctrl+[).\n"
                                   "Locked features and fixed points stay."));
    QPointF m_clicked; ///< in the view
    QPoint m_grip;     ///< where the hand has taken hold of it
    bool m_held = false;
};

ProbePanel::ProbePanel(Services& services, ProbeController& probe, VolumeView& view)
    : QFrame(&view), m_services(services), m_probe(probe), m_view(view) {
    setObjectName("probePanel");
    setAccessibleName(tr("Probe"));
    setFrameShape(QFrame::StyledPanel);
    setAutoFillBackground(true);
    setFixedWidth(kWidth);
    setCursor(Qt::ArrowCursor);
    for (QPushButton* b : {m_more, m_less}) {
        b->setAutoDefault(false);
        b->setFocusPolicy(Qt::TabFocus); // a click leaves the keys to the picture
    }
    auto* close = named(toolButton(QStringLiteral("×"), this), "closeProbeButton", tr("End the probe (Esc)"));
    close->setAutoRaise(true);
    close->setFocusPolicy(Qt::TabFocus);
    m_text->setTextInteractionFlags(Qt::TextSelectableByMouse);
    m_text->setCursor(Qt::IBeamCursor);
    m_text->setToolTip(
        tr("At the mark: value in data units, and the place: of a patient in mm, LPS (to the left, the back "
           "and the head) or RAS (to the right, the front and the head), as chosen in the panel "
           "Measures. Can be selected and copied."));
    m_readout->setMinimumHeight(fontMetrics().height());
    m_readout->setTextFormat(Qt::PlainText);
    m_title->setTextFormat(Qt::PlainText);
    makeBold(*m_title);
    m_scroll->setWidget(m_shares);
    m_scroll->setWidgetResizable(true);
    m_scroll->setFrameShape(QFrame::NoFrame);
    m_scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    auto* head = rowOf({{m_title, 1}});
    head->addWidget(close, 0, Qt::AlignTop);
    setLayout(inset(columnOf({head, m_plot, m_readout, m_scroll, m_text, m_hint, rowOf({m_more, m_less})}, 5),
                    {10, 6, 10, 8}));
    hide();

    connect(close, &QToolButton::clicked, &m_probe, &ProbeController::clear);
    connect(m_more, &QPushButton::clicked, this, [this] { m_probe.emphasize(true); });
    connect(m_less, &QPushButton::clicked, this, [this] { m_probe.emphasize(false); });
    connect(m_plot, &ProbePlot::readOut, this, [this](const QString& text) {
        m_readout->setText(text.isEmpty() ? tr("Move the mouse over the plot to read its values") : text);
    });
    m_readout->setText(tr("Move the mouse over the plot to read its values"));
    connect(&m_probe, &ProbeController::changed, this, &ProbePanel::refresh);
    connect(&services, &Services::readOnlyChanged, this, &ProbePanel::refresh);
    connect(&services.store(), &SessionStore::changed, this, [this] { // its mode, names and colours
        if (m_probe.isActive()) refresh();
    });
    connect(&view, &VolumeView::clicked, this, [this](const QPointF& point) {
        m_clicked = point;
        m_probe.probeAt(point, m_view.size(), m_view.devicePixelRatioF());
    });
    view.installEventFilter(this);
}

void ProbePanel::refresh() {
    const bool wasShown = !isHidden();
    setVisible(m_probe.isActive());
    m_view.overlay().update();
    if (!m_probe.isActive()) return;
    refreshText();
    m_shares->updateGeometry();
    m_scroll->setFixedHeight(std::min(m_shares->sizeHint().height(), kMostRowsHeight));
    m_plot->update();
    m_shares->update();
    for (QPushButton* b : {m_more, m_less}) b->setEnabled(m_probe.canEmphasize());
    // In a small view, such as beside slices, there is no room for the plot.
    for (const bool withPlot : {true, false}) {
        m_plot->setVisible(withPlot);
        m_readout->setVisible(withPlot);
        layout()->activate();
        resize(kWidth, layout()->hasHeightForWidth() ? layout()->totalHeightForWidth(kWidth) : sizeHint().height());
        if (height() <= m_view.height() - 2 * kMargin) break;
    }
    if (!wasShown) move(m_clicked.x() > m_view.width() / 2.0 ? kMargin : m_view.width() - kWidth - kMargin, kMargin);
    keepInView();
    raise();
}

void ProbePanel::refreshText() {
    const RayProbe& ray = m_probe.ray();
    const Scene& scene = m_services.scene();
    const int f = m_probe.feature();
    const auto percent = [](double share) { return QStringLiteral("%1 %").arg(100 * share, 0, 'f', 1); };
    m_title->setText(f >= 0 ? tr("%1: %2 of the pixel")
                                  .arg(QString::fromStdString(m_probe.tf().features[static_cast<std::size_t>(f)].name),
                                       percent(ray.shares[static_cast<std::size_t>(f)]))
                            : tr("In no feature"));
    const Volume& volume = *scene.volume;
    const auto value = m_probe.valueAtPlace();
    QString text = tr("%1 opaque").arg(percent(ray.alpha));
    text += tr(" · value %1").arg(value ? ProbePlot::valueText(scene, *value) : tr("invalid"));
    text += tr(" · at %1").arg(placeText(volume.geometry(), scene.session.coordinates->axes, m_probe.place()));
    m_text->setText(text);
    const bool composite = scene.session.display->mode == RenderMode::Composite;
    m_hint->setVisible(!composite);
    if (!composite) m_hint->setText(tr("Shares are those of composite mode."));
}

void ProbePanel::keepInView() {
    const QRect room = m_view.rect().adjusted(kMargin, kMargin, -kMargin, -kMargin);
    const int x = std::clamp(pos().x(), room.left(), std::max(room.left(), room.right() + 1 - width()));
    const int y = std::clamp(pos().y(), room.top(), std::max(room.top(), room.bottom() + 1 - height()));
    move(x, y);
}

void ProbePanel::mousePressEvent(QMouseEvent* event) {
    event->accept(); // not for the view
    m_held = event->button() == Qt::LeftButton;
    m_grip = event->position().toPoint();
}

void ProbePanel::mouseMoveEvent(QMouseEvent* event) {
    event->accept();
    if (!m_held) return;
    move(mapToParent(event->position().toPoint() - m_grip));
    keepInView();
}

void ProbePanel::mouseReleaseEvent(QMouseEvent* event) {
    event->accept();
    m_held = false;
}

void ProbePanel::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape) return m_probe.clear();
    QFrame::keyPressEvent(event);
}

bool ProbePanel::eventFilter(QObject* watched, QEvent* event) {
    if (m_probe.isActive()) {
        if (event->type() == QEvent::Resize) refresh();
        if (event->type() == QEvent::MouseButtonDblClick) m_probe.clear(); // it fits the view
        if (event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape &&
            !m_view.overlay().isDragging()) {
            m_probe.clear();
            return true;
        }
    }
    return QFrame::eventFilter(watched, event);
}

} // namespace

void addProbe(Services& services, ProbeController& probe, VolumeView& view) {
    view.overlay().add(std::make_unique<ProbeLayer>(probe));
    new ProbePanel(services, probe, view);
}

} // namespace pellucid::gui
