// A parameter space as a picture: of three features a volume for any ImageRenderer, of two a heat map; axes, legend and
// the paths of searches are marks over it (thesis figs 5.2, 5.3, 5.5).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "optimize/optimizer.h"
#include "optimize/space/parameter_space.h"
#include "render/annotation.h"
#include "session/session.h"

namespace pellucid {

/// The way of a search through the opacities: its start, then one state after each move.
struct SpacePath {
    std::string name;
    Rgb color;
    std::vector<OptimizeState> states; ///< opacities and VWS of all features of the space
    std::size_t best = 0;              ///< index into states
    bool operator==(const SpacePath&) const = default;
};
/// The n-th colour for paths; they differ from each other and from the colours of F.
Rgb pathColor(std::size_t n);

/// The optimizations among `runs` as ways through the opacities of `tf`, the oldest first: those whose features had the
/// names of all that have an axis. A feature that a run does not name has the opacity and VWS 0.
std::vector<SpacePath> pathsOfRuns(const std::vector<Run>& runs, const TransferFunction& tf, const ParameterAxes& axes);

/// What is drawn of a space, and how.
struct SpaceView {
    int shown = kObjective;         ///< or a feature
    std::vector<std::string> names; ///< of all features
    std::vector<Rgb> colors;        ///< of all features
    double tolerance = 0.03;        ///< the F within which targets count as reached: a contour of the heat map
    std::vector<SpacePath> paths;
    std::optional<std::vector<double>> present; ///< opacities of all features now: a square
    Camera camera;                              ///< of the volume, see spaceCamera(); nothing to a heat map
    int width = 512, height = 512;              ///< pixels
    double density = 1;                         ///< pixels in which lengths of the screen are one
    Rgb background{0, 0, 0};
    bool operator==(const SpaceView&) const = default;
};

// ---- three features

/// From where it is seen when nobody says: all three axes at their low ends.
inline constexpr double kSpaceAzimuth = 35, kSpaceElevation = 25;
/// The whole of it, with room for what stands at its edges; degrees as in cameraFromView().
Camera spaceCamera(const ParameterSpace& space, double azimuth, double elevation, double zoom = 1);

/// Samples at ParameterSpace::geometry(); the window of W is [0,1], that of F the range of its values.
std::shared_ptr<const Volume> spaceVolume(const ParameterSpace& space, int shown);
/// W: colour and opacity grow with it. F: low values from blue, high ones to orange, and those between (between the
/// quantiles 0.12 and 0.8 of the samples) transparent. The same looks for any number of samples.
TransferFunction spaceTf(const ParameterSpace& space, const SpaceView& view);
RenderSettings spaceRenderSettings(const ParameterSpace& space, const SpaceView& view);

// ---- two features

/// Where the heat map lies in the picture: x from left to right, y upward.
PixelBox heatMapBox(const ParameterSpace& space, const SpaceView& view);
/// The map, linear between samples, and the background around it.
Image heatMap(const ParameterSpace& space, const SpaceView& view);
/// Its colour at `value`, where values go over `range`.
Rgb heatMapColor(double value, const ValueRange& range);

// ---- both

/// The finished picture, marks and all. Throws Cancelled.
Image spaceImage(const ParameterSpace& space, const SpaceView& view, const JobControl& job = {});
/// Axes with names and ticks, legend, paths, the minimum, and of a heat map of F the contour of the tolerance.
std::vector<Mark> spaceMarks(const ParameterSpace& space, const SpaceView& view);
/// Where a position lies in the picture; empty where it is behind the eye.
std::optional<Vec2> pixelOf(const ParameterSpace& space, const SpaceView& view, const Vec3& position);
/// What a pixel shows: of a heat map the position below it; of a volume, of the positions along its ray the one of the
/// least F or the largest W. Empty beside the space.
std::optional<Vec3> positionAt(const ParameterSpace& space, const SpaceView& view, const Vec2& pixel);

/// A state of a path that is drawn within `reach` pixels of a pixel: the nearest.
struct PathState {
    std::size_t path = 0, state = 0;
    bool operator==(const PathState&) const = default;
};
std::optional<PathState> pathStateAt(const ParameterSpace& space, const SpaceView& view, const Vec2& pixel,
                                     double reach);

} // namespace pellucid
