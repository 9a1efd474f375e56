// Loops over voxels, and access to the samples of a volume in their own type.
#pragma once

#include <variant>

#include "base/job.h"
#include "base/parallel.h"
#include "volume/volume.h"

namespace pellucid {

/// The voxel of an index, see voxelIndex().
inline Int3 voxelAt(const Int3& dims, std::size_t index) {
    const auto nx = static_cast<std::size_t>(dims.x), layer = layerSize(dims);
    return {static_cast<int>(index % nx), static_cast<int>(index % layer / nx), static_cast<int>(index / layer)};
}

/// use(samples), where samples[i] is the value of voxel i in the volume's own type.
template <class Use>
decltype(auto) withSamples(const Volume& volume, const Use& use) {
    return std::visit(use, volume.samples());
}

/// Calls body(samples, i) for every voxel i; each layer on any thread. Throws Cancelled.
template <class Body>
void forEachVoxel(const Volume& volume, const JobControl& job, const Body& body) {
    const std::size_t layer = layerSize(volume.dims());
    withSamples(volume, [&](const auto& samples) {
        parallelFor(static_cast<std::size_t>(volume.dims().z), [&](std::size_t k) {
            job.throwIfStopped();
            for (std::size_t i = k * layer; i < (k + 1) * layer; ++i) body(samples, i);
        });
    });
}

/// Calls body(place, index) for every voxel of a grid; each layer on any thread. Throws Cancelled.
template <class Body>
void forEachPlace(const Int3& dims, const JobControl& job, const Body& body) {
    parallelFor(static_cast<std::size_t>(dims.z), [&](std::size_t layer) {
        job.throwIfStopped();
        std::size_t index = layer * layerSize(dims);
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) body(Int3(i, j, static_cast<int>(layer)), index++);
    });
}

} // namespace pellucid
