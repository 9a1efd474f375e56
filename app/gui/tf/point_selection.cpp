#include "tf/point_selection.h"

#include <algorithm>
#include <iterator>

#include "tf/edit.h"

namespace pellucid::gui {

PointSelection::PointSelection(std::vector<int> indices, int current)
    : m_indices(std::move(indices)), m_current(current) {
    std::sort(m_indices.begin(), m_indices.end());
    m_indices.erase(std::unique(m_indices.begin(), m_indices.end()), m_indices.end());
    if (!contains(m_current)) m_current = m_indices.empty() ? -1 : m_indices.back();
}

bool PointSelection::contains(int index) const { return std::binary_search(m_indices.begin(), m_indices.end(), index); }

PointSelection PointSelection::toggled(int index) const {
    std::vector<int> indices = m_indices;
    if (contains(index)) {
        std::erase(indices, index);
        return PointSelection(std::move(indices), m_current);
    }
    indices.push_back(index);
    return PointSelection(std::move(indices), index);
}

PointSelection PointSelection::united(const PointSelection& other) const {
    std::vector<int> indices = m_indices;
    indices.insert(indices.end(), other.m_indices.begin(), other.m_indices.end());
    return PointSelection(std::move(indices), other.isEmpty() ? m_current : other.m_current);
}

PointSelection PointSelection::followed(const std::vector<ControlPoint>& before,
                                        const std::vector<ControlPoint>& after) const {
    if (before.size() == after.size()) return *this;
    std::vector<int> indices;
    int current = -1;
    for (const int index : m_indices) {
        if (static_cast<std::size_t>(index) >= before.size()) continue;
        const auto same = std::find(after.begin(), after.end(), before[static_cast<std::size_t>(index)]);
        if (same == after.end()) continue;
        indices.push_back(static_cast<int>(same - after.begin()));
        if (index == m_current) current = indices.back();
    }
    return PointSelection(std::move(indices), current);
}

TransferFunction withPointsMoved(const TransferFunction& tf, const PointSelection& points, double dx,
                                 const std::function<double(double)>& opacity) {
    const auto x = [&](int index) {
        if (index < 0) return 0.0;
        if (static_cast<std::size_t>(index) >= tf.points.size()) return 1.0;
        return tf.points[static_cast<std::size_t>(index)].x;
    };
    for (const int index : points.indices()) {
        if (!points.contains(index - 1)) dx = std::max(dx, x(index - 1) - x(index));
        if (!points.contains(index + 1)) dx = std::min(dx, x(index + 1) - x(index));
    }
    // The foremost first, so that none stands in the way of the next.
    std::vector<int> order = points.indices();
    if (dx > 0) std::reverse(order.begin(), order.end());
    TransferFunction result = tf;
    for (const int index : order) {
        const double before = tf.points[static_cast<std::size_t>(index)].opacity;
        result = withPointMoved(result, index, x(index) + dx, opacity(before));
    }
    return result;
}

TransferFunction withPointsAt(const TransferFunction& tf, const PointSelection& points, std::optional<double> x,
                              std::optional<double> opacity) {
    std::vector<int> order = points.indices();
    if (x) { // those that go up from the last on, then those that go down from the first on
        const auto goesUp = [&](int index) { return tf.points[static_cast<std::size_t>(index)].x < *x; };
        const auto down = std::stable_partition(order.begin(), order.end(), goesUp);
        std::reverse(order.begin(), down);
    }
    TransferFunction result = tf;
    for (const int index : order) {
        const ControlPoint& point = tf.points[static_cast<std::size_t>(index)];
        result = withPointMoved(result, index, x.value_or(point.x), opacity.value_or(point.opacity));
    }
    return result;
}

TransferFunction withPointsRemoved(TransferFunction tf, const PointSelection& points) {
    for (auto index = points.indices().rbegin(); index != points.indices().rend(); ++index)
        tf = withPointRemoved(tf, *index);
    return tf;
}

TransferFunction withPointsFixed(TransferFunction tf, const PointSelection& points, bool fixed) {
    for (const int index : points.indices()) tf = withPointFixed(tf, index, fixed);
    return tf;
}

TransferFunction withPointsColor(TransferFunction tf, const PointSelection& points, const Rgb& color) {
    for (const int index : points.indices()) tf = withPointColor(tf, index, color);
    return tf;
}

} // namespace pellucid::gui
