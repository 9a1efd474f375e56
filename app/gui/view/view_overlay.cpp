#include "view/view_overlay.h"

#include <algorithm>

#include <QPainter>

#include "widgets/shown_vision.h"

namespace pellucid::gui {

ViewOverlay::ViewOverlay(SessionStore& store, QWidget* view) : QWidget(view), m_store(store) {
    setObjectName("viewOverlay");
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setAttribute(Qt::WA_NoSystemBackground);
    setFocusPolicy(Qt::NoFocus);
    followShownVision(*this);
    connect(&store, &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.series != after.series) cancel(); // what was taken hold of is gone
        if (m_glimpse) lookFrom(m_glimpse->camera);
    });
}

void ViewOverlay::lookFrom(const std::optional<Camera>& camera) {
    m_glimpse.reset();
    if (camera) {
        m_glimpse = m_store.scene();
        m_glimpse->camera = *camera;
    }
    update();
}

void ViewOverlay::add(std::unique_ptr<OverlayLayer> layer) {
    m_layers.push_back(std::move(layer));
    update();
}

bool ViewOverlay::press(const QPointF& point, Qt::KeyboardModifiers keys) {
    if (!m_store.hasVolume()) return false;
    for (auto layer = m_layers.rbegin(); layer != m_layers.rend(); ++layer)
        if ((*layer)->press(point, keys, overlayView())) {
            m_holder = layer->get();
            return true;
        }
    return false;
}

void ViewOverlay::drag(const QPointF& point, Qt::KeyboardModifiers keys) {
    if (m_holder != nullptr && m_store.hasVolume()) m_holder->drag(point, keys, overlayView());
}

void ViewOverlay::end(bool kept) {
    if (m_holder != nullptr) m_holder->end(kept);
    m_holder = nullptr;
}

bool ViewOverlay::wantsClicks() const {
    return m_store.hasVolume() &&
           std::any_of(m_layers.begin(), m_layers.end(), [](const auto& layer) { return layer->wantsClicks(); });
}

void ViewOverlay::click(const QPointF& point) {
    for (auto layer = m_layers.rbegin(); layer != m_layers.rend(); ++layer)
        if ((*layer)->wantsClicks()) return (*layer)->click(point, overlayView());
}

bool ViewOverlay::key(int key) {
    if (!m_store.hasVolume() || isDragging()) return false;
    for (auto layer = m_layers.rbegin(); layer != m_layers.rend(); ++layer)
        if ((*layer)->key(key, overlayView())) return true;
    return false;
}

Qt::CursorShape ViewOverlay::cursorAt(const QPointF& point) {
    if (!m_store.hasVolume()) return Qt::ArrowCursor;
    for (auto layer = m_layers.rbegin(); layer != m_layers.rend(); ++layer)
        if (const Qt::CursorShape shape = (*layer)->cursorAt(point, overlayView()); shape != Qt::ArrowCursor)
            return shape;
    return Qt::ArrowCursor;
}

void ViewOverlay::paintEvent(QPaintEvent*) {
    if (!m_store.hasVolume()) return;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    for (const auto& layer : m_layers) layer->paint(painter, overlayView());
}

} // namespace pellucid::gui
