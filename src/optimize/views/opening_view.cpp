#include "optimize/views/opening_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "optimize/ray_bundle.h"
#include "render/camera_motion.h"
#include "render/drawn_cells.h"
#include "render/drawn_part.h"
#include "render/view_direction.h"

namespace pellucid {

namespace {

constexpr int kRaysAlongSide = 32;

/// Toward the faces, edges and corners of a cube.
std::vector<Vec3> directionsAround() {
    std::vector<Vec3> directions;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (x != 0 || y != 0 || z != 0) directions.push_back(glm::normalize(Vec3(x, y, z)));
    return directions;
}

} // namespace

double shownLeast(const Volume& volume, const TransferFunction& tf, const View& view, const JobControl& job) {
    const RayBundle rays(volume, tf, view, kRaysAlongSide, job);
    const std::size_t features = tf.features.size();
    std::vector<TransferFunction> tfs{tf};
    const std::vector<double> peaks = featureOpacities(tf);
    for (std::size_t f = 0; f < features; ++f) {
        std::vector<double> alone(features, 0.0);
        alone[f] = peaks[f];
        tfs.push_back(withFeatureOpacities(tf, alone));
    }
    const std::vector<RayBundle::Appearance> seen = rays.appearances(tfs);
    double least = 1;
    for (std::size_t f = 0; f < features; ++f)
        if (const double alone = seen[f + 1].covers[f]; alone > 0) least = std::min(least, seen[0].covers[f] / alone);
    // A slab is to be seen from its face; that boxes fill more of the picture when they look flat is no reason for
    // that.
    return least * std::sqrt(std::sqrt(rays.rays()) / kRaysAlongSide);
}

View openingView(const Volume& volume, const TransferFunction& tf, const std::optional<Holder>& holder,
                 const JobControl& job) {
    constexpr double kClearly = 1.1;    // times as much
    constexpr double kFromBelow = 1.15; // times as much must be seen from below the horizon to be worth it
    const Geometry& geometry = volume.geometry();
    const Camera usual = homeCamera(geometry, Projection::Perspective);
    Clipping clipping;
    if (holder) clipping.rest.within = holder->without;
    const DrawnPart part = drawnPart(volume, tf, clipping, job);
    const View fitting(fittedTo(part, usual, geometry), clipping);
    if (geometry.worldAxes == WorldAxes::Patient || part.empty() || tf.features.empty()) return fitting;

    struct Candidate {
        Camera camera;
        double shown, turned; ///< shownLeast(), and the cosine of the angle from the usual direction
    };
    // What the object lies on is behind it.
    const auto isBesideHolder = [&](const Vec3& toEye) { return holder && glm::dot(toEye, holder->toward) > -0.1; };
    // How its opacities are balanced is found for the view, so that it has no say in the view.
    const TransferFunction even = withEvenPeaks(tf, geometry, 0.9, 0.25);
    std::vector<Candidate> candidates;
    for (const Vec3& toEye : directionsAround()) {
        if (isBesideHolder(toEye)) continue;
        const Camera camera = fittedTo(part, lookingFrom(usual, geometry, toEye), geometry);
        const double shown = shownLeast(volume, even, camera, job) / (toEye.z < 0 ? kFromBelow : 1);
        candidates.push_back({camera, shown, -glm::dot(toEye, usual.forward())});
    }
    const double most = std::ranges::max_element(candidates, {}, &Candidate::shown)->shown;
    if (!isBesideHolder(-usual.forward()) && shownLeast(volume, even, fitting.camera, job) * kClearly >= most)
        return fitting;
    // Of those that are about as good, the one nearest to the usual direction.
    std::erase_if(candidates, [&](const Candidate& c) { return c.shown * kClearly < most; });
    return {std::ranges::max_element(candidates, {}, &Candidate::turned)->camera, clipping};
}

} // namespace pellucid
