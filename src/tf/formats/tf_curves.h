// Transfer functions as VTK keeps them, and with it ParaView and 3D Slicer: a curve of colours and one of opacities,
// each of points of its own (docs/method.md, "Transfer functions of other programs").
#pragma once

#include <string>
#include <vector>

#include "tf/color_spaces.h"
#include "tf/transfer_function.h"

namespace pellucid {

/// How the way from a point to the next one runs: half of it is done at `midpoint`, a part of the distance; with
/// `sharpness` 0 on straight lines, with 1 by a step there.
struct CurveShape {
    double midpoint = 0.5, sharpness = 0; ///< both [0,1]
    bool isStraight() const { return midpoint == 0.5 && sharpness < 0.01; }
    bool isStep() const { return sharpness > 0.99; }
};

struct ColorNode {
    double x = 0; ///< in the units of the file
    Rgb color;
    CurveShape shape;
};
struct OpacityNode {
    double x = 0;
    double opacity = 0; ///< [0,1]
    CurveShape shape;
};

/// Nodes are sorted by x. Where several share an x there is a step from the first to the last of them. Beyond the outer
/// ones their values hold.
struct TfCurves {
    std::vector<ColorNode> colors;
    std::vector<OpacityNode> opacities;
    ColorSpace space = ColorSpace::Rgb;
    bool isLogarithmic = false; ///< between nodes log x counts in the place of x; all x > 0

    void sort(); ///< what shares an x keeps its order
    /// Of nodes that share an x the last one stays.
    void keepLastOfEach();
    /// Smallest and largest x; {0, 0} without any node.
    ValueRange range() const;
};

/// The most nodes that a curve of a file may have.
inline constexpr std::size_t kMostNodes = 65536;
/// Each piece between two of these is a way through all colours, which takes long to find.
inline constexpr std::size_t kMostCiede2000Nodes = 256;

double opacityAt(const TfCurves& curves, double x); ///< 0 without nodes
Rgb colorAt(const TfCurves& curves, double x);      ///< white without nodes

/// Straight lines miss the curves by less than this: ΔE*ab of colours, and opacities.
inline constexpr double kCurveTolerance = 1.0, kOpacityTolerance = 0.002;

struct CurvePoints {
    std::vector<ControlPoint> points; ///< x from 0 to 1 over `range`; those of opacity 0 are fixed
    bool areResampled = false;        ///< some stand for a curve that is not straight
};
/// Control points for both curves: one wherever either has a node, and more where straight lines would miss them.
/// range.lo < range.hi; nodes beyond it are cut off.
CurvePoints pointsOf(const TfCurves& curves, const ValueRange& range);

} // namespace pellucid
