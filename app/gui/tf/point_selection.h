// Which control points are selected, and what is done to several at once.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tf/transfer_function.h"

namespace pellucid::gui {

/// Indices of points, ascending; one of them, the one chosen last, is the current one.
class PointSelection {
public:
    PointSelection() = default;
    explicit PointSelection(std::vector<int> indices, int current = -1);

    const std::vector<int>& indices() const { return m_indices; }
    int current() const { return m_current; } ///< −1: none
    bool isEmpty() const { return m_indices.empty(); }
    std::size_t size() const { return m_indices.size(); }
    bool contains(int index) const;
    /// With `index` if it is not in it, else without.
    PointSelection toggled(int index) const;
    PointSelection united(const PointSelection& other) const;
    /// The same points after an edit: those in their places where none came or went, else those that are as they were.
    PointSelection followed(const std::vector<ControlPoint>& before, const std::vector<ControlPoint>& after) const;

    bool operator==(const PointSelection&) const = default;

private:
    std::vector<int> m_indices;
    int m_current = -1;
};

/// Points moved by `dx`, as far as the points between and beside them let all of them go; their opacities through
/// `opacity`. Features' ends go along as in withPointMoved().
TransferFunction withPointsMoved(const TransferFunction& tf, const PointSelection& points, double dx,
                                 const std::function<double(double)>& opacity);
/// All at one intensity (as near as their neighbours let them), or of one opacity.
TransferFunction withPointsAt(const TransferFunction& tf, const PointSelection& points, std::optional<double> x,
                              std::optional<double> opacity);
TransferFunction withPointsRemoved(TransferFunction tf, const PointSelection& points);
TransferFunction withPointsFixed(TransferFunction tf, const PointSelection& points, bool fixed);
TransferFunction withPointsColor(TransferFunction tf, const PointSelection& points, const Rgb& color);

} // namespace pellucid::gui
