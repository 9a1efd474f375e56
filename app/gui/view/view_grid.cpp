#include "view/view_grid.h"

#include <algorithm>

#include <QMouseEvent>
#include <QPainter>

#include "controllers/comparison_controller.h"
#include "services/services.h"
#include "view/compared_view.h"
#include "view/slice_bar.h"
#include "view/wipe_divider.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

using Layout = SliceViews::Layout;

constexpr int kGap = 4;
constexpr double kLeast = 0.12; // of the area, for each row and column

} // namespace

ViewGrid::ViewGrid(Services& services, const FieldController& fields, RulerController& rulers, VolumeView& volume,
                   ComparisonController& comparing, QWidget* parent)
    : QWidget(parent), m_services(services), m_volume(volume), m_comparing(comparing),
      m_bar(new SliceBar(services, this)) {
    setObjectName("viewGrid");
    setMouseTracking(true);
    volume.setParent(this);
    m_compared = new ComparedView(comparing, volume, this);
    m_divider = new WipeDivider(comparing, this);
    connect(m_compared, &ComparedView::pictureShown, this, &ViewGrid::slicesShown);
    connect(&comparing, &ComparisonController::sceneChanged, this, &ViewGrid::followComparison);
    for (int a = 0; a < 3; ++a) {
        auto* pane = new SlicePane(services, fields, rulers, a, m_lane, this);
        m_panes[static_cast<std::size_t>(a)] = pane;
        pane->hide();
        connect(pane, &SlicePane::pictureShown, this, &ViewGrid::slicesShown);
        connect(pane, &SlicePane::maximizeWanted, this, [this, pane] { maximize(m_alone == pane ? nullptr : pane); });
    }
    connect(&services.store(), &SessionStore::changed, this, [this] {
        if (layoutNow() == m_arranged) return;
        m_alone = nullptr;
        arrange();
    });
    arrange();
}

ViewGrid::~ViewGrid() {
    for (SlicePane* pane : m_panes) delete pane; // before the lane that they draw on
}

SliceViews::Layout ViewGrid::layoutNow() const {
    return m_services.store().hasVolume() ? m_services.store().session().slices->layout : Layout::Volume;
}

bool ViewGrid::isComplete() const {
    return (m_volume.isHidden() || m_volume.isComplete()) && (m_compared->isHidden() || m_compared->isComplete()) &&
           std::all_of(m_panes.begin(), m_panes.end(), [](const SlicePane* p) { return p->isComplete(); });
}

void ViewGrid::maximize(SlicePane* pane) {
    m_alone = pane;
    for (SlicePane* p : m_panes) p->setMaximized(p == pane);
    arrange();
    if (pane != nullptr) pane->setFocus();
}

QRect ViewGrid::area() const {
    QRect r = rect();
    if (!m_bar->isHidden()) r.setTop(m_bar->sizeHint().height());
    return r;
}

void ViewGrid::arrange() {
    m_arranged = layoutNow();
    const bool slices = m_arranged != Layout::Volume;
    m_bar->setVisible(slices);
    m_bar->setGeometry(0, 0, width(), m_bar->sizeHint().height());
    const QRect all = area();
    const auto show = [this](QWidget& widget, const QRect& place) {
        widget.setGeometry(place);
        widget.setVisible(m_alone == nullptr || m_alone == &widget);
    };
    const auto between = [](int from, int extent, double a, double b) { // without the gaps
        const int first = from + (a > 0 ? static_cast<int>(a * extent) + kGap / 2 : 0);
        const int last = from + (b < 1 ? static_cast<int>(b * extent) - kGap / 2 : extent);
        return std::pair{first, std::max(first + 1, last)};
    };
    const auto cell = [&](double x0, double x1, double y0, double y1) {
        const auto [left, right] = between(all.left(), all.width(), x0, x1);
        const auto [top, bottom] = between(all.top(), all.height(), y0, y1);
        return QRect(left, top, right - left, bottom - top);
    };
    const auto showVolume = [&](const QRect& place) {
        m_volume.setVisible(m_alone == nullptr);
        placeVolume(place);
    };
    SlicePane &x = *m_panes[0], &y = *m_panes[1], &z = *m_panes[2];
    if (m_alone != nullptr) {
        showVolume(all);
        for (QWidget* widget : std::initializer_list<QWidget*>{&x, &y, &z}) show(*widget, all);
    } else if (m_arranged == Layout::Four) { // axial and the volume above, coronal and sagittal below
        show(z, cell(0, m_fourX, 0, m_fourY));
        showVolume(cell(m_fourX, 1, 0, m_fourY));
        show(y, cell(0, m_fourX, m_fourY, 1));
        show(x, cell(m_fourX, 1, m_fourY, 1));
    } else if (m_arranged == Layout::VolumeLarge) {
        showVolume(cell(0, m_largeX, 0, 1));
        show(z, cell(m_largeX, 1, 0, m_largeY[0]));
        show(y, cell(m_largeX, 1, m_largeY[0], m_largeY[1]));
        show(x, cell(m_largeX, 1, m_largeY[1], 1));
    } else {
        showVolume(all);
        for (SlicePane* pane : m_panes) pane->hide();
    }
    update();
    Q_EMIT slicesShown();
}

void ViewGrid::placeVolume(const QRect& place) {
    const bool shown = m_alone == nullptr && m_comparing.isShown();
    m_compareMode = shown ? m_comparing.view().mode : CompareMode::Off;
    m_arrangedDivider = m_comparing.view().divider;
    const bool wipes = m_compareMode == CompareMode::Wipe, pairs = m_compareMode == CompareMode::SideBySide;
    QRect a = place;
    if (pairs) a.setWidth(std::max(1, (place.width() - kGap) / 2)); // both of one size
    m_volume.setGeometry(a);
    if (pairs) {
        const QRect b = a.translated(a.width() + kGap, 0);
        m_compared->place(b, b);
    } else if (wipes) {
        QRect seen = a;
        seen.setLeft(std::min(a.right(), a.left() + m_divider->columnOf(a.width()))); // a pixel is left of it
        m_compared->place(a, seen);
        m_divider->place(a);
    }
    m_compared->setShown(pairs || wipes);
    m_divider->setVisible(wipes);
    if (wipes) {
        m_compared->raise();
        m_divider->raise();
    }
}

void ViewGrid::followComparison() {
    const CompareMode mode = m_alone == nullptr && m_comparing.isShown() ? m_comparing.view().mode : CompareMode::Off;
    const bool moved = mode == CompareMode::Wipe && m_arrangedDivider != m_comparing.view().divider;
    if (mode != m_compareMode || moved) arrange();
}

void ViewGrid::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    arrange();
}

int ViewGrid::gapsAt(const QPoint& point) const {
    const QRect all = area();
    if (m_arranged == Layout::Volume || m_alone != nullptr || !all.contains(point)) return 0;
    const double x = static_cast<double>(point.x() - all.left()), y = static_cast<double>(point.y() - all.top());
    const auto near = [](double at, double share, int extent) { return std::abs(at - share * extent) <= kGap; };
    if (m_arranged == Layout::Four)
        return (near(x, m_fourX, all.width()) ? Upright : 0) | (near(y, m_fourY, all.height()) ? Level : 0);
    if (near(x, m_largeX, all.width())) return Upright;
    return near(y, m_largeY[0], all.height()) ? Level : near(y, m_largeY[1], all.height()) ? SecondLevel : 0;
}

void ViewGrid::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) m_dragged = gapsAt(event->position().toPoint());
}

void ViewGrid::mouseMoveEvent(QMouseEvent* event) {
    const int gaps = m_dragged != 0 ? m_dragged : gapsAt(event->position().toPoint());
    const bool upright = (gaps & Upright) != 0, level = (gaps & (Level | SecondLevel)) != 0;
    setCursor(upright && level ? Qt::SizeAllCursor
              : upright        ? Qt::SplitHCursor
              : level          ? Qt::SplitVCursor
                               : Qt::ArrowCursor);
    if (m_dragged == 0) return;
    const QRect all = area();
    const double x = (event->position().x() - all.left()) / std::max(1, all.width()),
                 y = (event->position().y() - all.top()) / std::max(1, all.height());
    const auto held = [](double at, double lo, double hi) { return std::clamp(at, lo + kLeast, hi - kLeast); };
    if (m_arranged == Layout::Four) {
        if ((m_dragged & Upright) != 0) m_fourX = held(x, 0, 1);
        if ((m_dragged & Level) != 0) m_fourY = held(y, 0, 1);
    } else {
        if ((m_dragged & Upright) != 0) m_largeX = held(x, 0, 1);
        if ((m_dragged & Level) != 0) m_largeY[0] = held(y, 0, m_largeY[1]);
        if ((m_dragged & SecondLevel) != 0) m_largeY[1] = held(y, m_largeY[0], 1);
    }
    arrange();
}

void ViewGrid::mouseReleaseEvent(QMouseEvent*) { m_dragged = 0; }

void ViewGrid::mouseDoubleClickEvent(QMouseEvent* event) {
    if (gapsAt(event->position().toPoint()) == 0) return;
    m_fourX = m_fourY = 0.5; // as they were at first
    m_largeX = 0.7;
    m_largeY = {1 / 3.0, 2 / 3.0};
    arrange();
}

void ViewGrid::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(area(), theme::kTitle);
}

} // namespace pellucid::gui
