// From what ParaView's processes hold of an image to a volume on ranks, and what the filters of the plugin compute of
// it. Knows VTK's data, not its pipeline.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "optimize/optimizer.h"
#include "ranks/piece_volume.h"
#include "session/scene.h"

class vtkDataArray;
class vtkImageData;

namespace pellucid::paraview {

/// What both filters are asked for. Lengths are the image's.
struct Asked {
    std::string transferFunction;        ///< as loadTf() takes it; empty or "auto": what the data propose
    bool byDirection = false;            ///< from azimuth and elevation, else by the camera below
    double azimuth = 30, elevation = 20; ///< degrees
    std::array<double, 3> position{0, 0, 1}, focalPoint{0, 0, 0}, viewUp{0, 1, 0};
    double viewAngle = 30; ///< degrees, vertical
    bool parallel = false;
    double parallelScale = 1; ///< half of the picture's height
    int threads = 0;          ///< of each process; 0: what its machine has for it
};

/// What a filter is asked for.
template <class Filter>
Asked askedOf(Filter& filter) {
    Asked asked;
    asked.transferFunction = filter.GetTransferFunction();
    asked.byDirection = filter.GetByDirection();
    filter.GetDirection(asked.azimuth, asked.elevation);
    filter.GetCameraPosition(asked.position.data());
    filter.GetCameraFocalPoint(asked.focalPoint.data());
    filter.GetCameraViewUp(asked.viewUp.data());
    asked.viewAngle = filter.GetCameraViewAngle();
    asked.parallel = filter.GetParallelProjection();
    asked.parallelScale = filter.GetParallelScale();
    return asked;
}

/// Calls work(ranks) with the processes that ParaView runs on, as one of which this one is. Returns what went wrong, as
/// the first process that can tell says it, on all processes; empty where nothing did.
std::string runOnRanks(int threads, const std::function<void(Communicator&)>& work);

/// The piece of an image, of which `values` are the values at its points; null where this process has none.
struct ImagePiece {
    ImagePiece(vtkImageData* image, vtkDataArray* values);
    VolumePiece piece;
};

/// The image with what is asked of it, ready to be measured. Collective. Throws Error.
struct Prepared {
    MeasureInput input;
    VoxelRegion piece; ///< of this process, in voxels of the volume
};
Prepared prepared(Communicator& ranks, const ImagePiece& image, const Asked& asked);

/// Of each point of this process's piece, in the order of VTK.
struct PieceField {
    std::string name;
    std::vector<float> values;
};
struct Seen {
    std::vector<PieceField> fields; ///< visibility, saliency, vws, and vws of each feature
    std::vector<std::string> features;
    std::vector<double> visibility, vws; ///< of each feature, sum 1
};
Seen seenOf(Communicator& ranks, const Prepared& prepared);

struct Answer {
    // Per feature, on the first process; empty on the others, so that the rows are there once.
    std::vector<std::string> features;
    std::vector<double> targets, vwsBefore, vwsAfter, opacityBefore, opacityAfter;
    std::string preset;      ///< paraViewPreset(), on all processes
    double unitDistance = 1; ///< that its opacities are of, world units
};
/// `targets`: as "1,2,2", or "equal". `file`: where the first process writes the answer, as writeTfFile() does; empty:
/// nowhere. Throws Error.
Answer optimized(Communicator& ranks, const Prepared& prepared, const std::string& targets, const std::string& file);

} // namespace pellucid::paraview
