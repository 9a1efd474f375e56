#include "widgets/fitting_row.h"

#include <algorithm>
#include <iterator>

#include <QWidget>

namespace pellucid::gui {
namespace {

constexpr int kOutside = -10; ///< where it is left out, a widget lies left of the one that has the row

}

FittingRow::~FittingRow() {
    for (const Cell& cell : m_cells) delete cell.item;
}

void FittingRow::add(QWidget* widget, int rank) {
    addWidget(widget);
    m_cells.back().rank = rank;
}

void FittingRow::addItem(QLayoutItem* item) { m_cells.push_back({item}); }

QLayoutItem* FittingRow::itemAt(int index) const {
    return index >= 0 && index < count() ? m_cells[static_cast<std::size_t>(index)].item : nullptr;
}

QLayoutItem* FittingRow::takeAt(int index) {
    if (itemAt(index) == nullptr) return nullptr;
    const auto at = m_cells.begin() + index;
    QLayoutItem* const item = at->item;
    m_cells.erase(at);
    if (m_gap > static_cast<std::size_t>(index)) --m_gap;
    return item;
}

QSize FittingRow::sizeHint() const {
    QSize size(0, 0);
    for (const Cell& cell : m_cells) {
        if (cell.item->isEmpty()) continue;
        const QSize wanted = cell.item->sizeHint();
        size = {size.width() + wanted.width() + spacing(), std::max(size.height(), wanted.height())};
    }
    return size;
}

std::vector<const FittingRow::Cell*> FittingRow::fitting(int width) const {
    std::vector<const Cell*> cells;
    int needed = -spacing();
    for (const Cell& cell : m_cells) {
        if (cell.item->isEmpty()) continue;
        cells.push_back(&cell);
        needed += cell.item->sizeHint().width() + spacing();
    }
    while (needed > width && !cells.empty()) {
        const auto last = std::max_element(cells.rbegin(), cells.rend(), // of one rank the one at the right
                                           [](const Cell* a, const Cell* b) { return a->rank < b->rank; });
        needed -= (*last)->item->sizeHint().width() + spacing();
        cells.erase(std::next(last).base());
    }
    return cells;
}

bool FittingRow::isLeftOut(const QWidget& widget) { return widget.geometry().right() < 0; }

void FittingRow::setGeometry(const QRect& rect) {
    QLayout::setGeometry(rect);
    const std::vector<const Cell*> shown = fitting(rect.width());
    const auto place = [&](const Cell& cell, int left, int width) {
        const int height = std::min(cell.item->sizeHint().height(), rect.height());
        cell.item->setGeometry({left, rect.top() + (rect.height() - height) / 2, width, height});
    };
    int right = rect.right() + 1;
    for (std::size_t i = m_cells.size(); m_gap > 0 && i-- > m_gap;) {
        if (std::ranges::find(shown, &m_cells[i]) == shown.end()) continue;
        const int width = m_cells[i].item->sizeHint().width();
        place(m_cells[i], right -= width, width);
        right -= spacing();
    }
    int left = rect.left();
    for (std::size_t i = 0; i < m_cells.size(); ++i) {
        const Cell& cell = m_cells[i];
        if (std::ranges::find(shown, &cell) == shown.end()) {
            cell.item->widget()->move(kOutside - cell.item->widget()->width(), rect.top());
        } else if (m_gap == 0 || i < m_gap) {
            const int width = cell.item->sizeHint().width();
            place(cell, left, width);
            left += width + spacing();
        }
    }
}

} // namespace pellucid::gui
