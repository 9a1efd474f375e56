#include "render/cpu/ray_volume.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "base/error.h"
#include "render/camera.h"

namespace pellucid {

namespace {

void copy(const Vec3& from, float (&to)[3]) {
    for (int a = 0; a < 3; ++a) to[a] = static_cast<float>(from[a]);
}

/// The same half-space in the voxels of another grid.
VoxelPlane inOther(const VoxelPlane& plane, const Geometry& from, const Geometry& to) {
    const Mat3 fromOther = from.indexFromWorld() * to.worldFromIndex();
    const Vec3 start = from.voxelFromWorld(to.worldFromVoxel(Vec3(0)));
    return {glm::transpose(fromOther) * plane.normal, plane.offset - glm::dot(plane.normal, start)};
}

} // namespace

const Feature* RayVolume::featureAlone() const {
    const int f = m_prepared.onlyFeature;
    return f < 0 ? nullptr : &m_prepared.tf.features[static_cast<std::size_t>(f)];
}

void RayVolume::prepare(const TransferFunction& tf, int onlyFeature, bool surfaces) {
    Prepared wanted{tf, onlyFeature, surfaces};
    if (m_table && m_prepared == wanted) return;
    m_table.reset();
    m_features.clear();
    m_openness.reset();
    m_prepared = std::move(wanted);
    if (surfaces) {
        prepareFeatures();
        m_table.emplace(
            [&](double s) {
                const float code = static_cast<float>(s * m_grid->maxCode);
                return std::ranges::any_of(m_features, [&](const auto& f) { return code >= f.low && code < f.high; });
            },
            *m_grid);
    } else {
        m_table.emplace(m_prepared.tf, featureAlone(), *m_grid);
    }
    m_distances = m_blocks.distances([&](int low, int high) { return m_table->isOpaque(low, high); });
}

/// Those that mode Surface draws.
void RayVolume::prepareFeatures() {
    const std::vector<double> peaks = featureOpacities(m_prepared.tf);
    const Feature* only = featureAlone();
    for (std::size_t f = 0; f < peaks.size(); ++f) {
        const Feature& feature = m_prepared.tf.features[f];
        if (peaks[f] <= 0 || (only && only != &feature)) continue;
        PacketScene::Feature to{lowestCode(feature), endCode(feature), {}, static_cast<float>(peaks[f])};
        copy({feature.color.r, feature.color.g, feature.color.b}, to.rgb);
        m_features.push_back(to);
    }
    if (m_features.size() > kMostSurfaces)
        throw Error(std::to_string(m_features.size()) + " features have an opacity", "surfaces",
                    "draw at most " + std::to_string(kMostSurfaces));
}

void RayVolume::fillVolume(PacketScene& s) const {
    const Int3 n = m_geometry.dims;
    s.codes = m_grid->codes.wide();
    s.narrowCodes = m_grid->codes.narrow();
    s.valid = m_grid->valid.empty() ? nullptr : m_grid->valid.data();
    for (int a = 0; a < 3; ++a) {
        s.dims[a] = n[a];
        s.blockDims[a] = m_blocks.dims()[a];
    }
    s.middleSlice = n.z / 2;
    s.middleVoxel = static_cast<std::int64_t>(s.middleSlice) * n.x * n.y;
    s.blockDistance = m_distances.data();
    s.blockRange = m_blocks.ranges().data();
    s.cellOfCode = m_table->cellOfCode();
    s.intensityOfCode = 1.0f / static_cast<float>(m_grid->maxCode);
    s.integral = m_table->integral();
    s.colors = m_table->colors();
    s.depthUnit = m_table->depthUnit();
    s.lastEntry = static_cast<float>(m_table->cells());
}

void RayVolume::fillCamera(const Camera& camera, const PictureRays& picture, PacketScene& s) const {
    const bool perspective = camera.projection == Projection::Perspective;
    const Vec3 ahead = camera.forward(), right = camera.right(), down = -camera.trueUp();
    const double half = perspective ? std::tan(glm::radians(camera.fovY) / 2) : camera.height / 2;
    const double perPixel = 2 * half / picture.height;
    PacketCamera& c = s.camera;
    c.middle[0] = static_cast<float>(picture.width / 2);
    c.middle[1] = static_cast<float>(picture.height / 2);
    copy(m_geometry.voxelFromWorld(camera.eye + picture.middle * ahead), c.point);
    copy(inVoxels(ahead), c.direction);
    for (int i = 0; i < 2; ++i) {
        const Vec3 side = inVoxels(perPixel * (i == 0 ? right : down));
        copy(perspective ? picture.middle * side : side, c.pointBy[i]);
        copy(perspective ? side : Vec3(0), c.directionBy[i]);
        c.slope[i] = perspective ? static_cast<float>(perPixel) : 0;
    }
    c.nearest = perspective ? static_cast<float>(-picture.middle) : -1e30f;
    s.step = static_cast<float>(picture.step);
    s.stepInD0 = static_cast<float>(picture.stepInD0);
}

void RayVolume::fillRegion(std::span<const VoxelPlane> part, const VoxelClipping& clipping, const Geometry& first,
                           PacketScene& s) const {
    const auto put = [](const Vec3& normal, double offset, PacketPlane& plane) {
        copy(normal, plane.normal);
        plane.offset = static_cast<float>(offset);
    };
    const auto add = [&](const Vec3& normal, double offset) { put(normal, offset, s.planes[s.planeCount++]); };
    for (int a = 0; a < 3; ++a) {
        Vec3 normal(0);
        normal[a] = 1;
        add(-normal, -m_geometry.voxelBoxMin()[a]);
        add(normal, m_geometry.voxelBoxMax()[a]);
    }
    const bool own = &first == &m_geometry;
    const auto moved = [&](const VoxelPlane& plane) { return own ? plane : inOther(plane, first, m_geometry); };
    for (const VoxelPlane& plane : part) add(moved(plane).normal, moved(plane).offset);
    for (const VoxelPlane& plane : clipping.cut) add(moved(plane).normal, moved(plane).offset);
    // An overlay, and modes that do not composite, have nothing there.
    const bool faint = own && s.mode == PacketMode::Composite && clipping.density > 0;
    if (faint) s.faintDensity = static_cast<float>(clipping.density);
    for (const VoxelPlane& plane : clipping.faint)
        if (faint)
            put(plane.normal, plane.offset, s.faintPlanes[s.faintCount++]);
        else
            add(moved(plane).normal, moved(plane).offset);
}

std::vector<std::array<float, 2>> RayVolume::entriesOfFeatures() const {
    const double cells = static_cast<double>(m_table->cells());
    // The cell i holds what RayTable takes at the intensity i / (cells − 1), and begins at the entry i.
    const auto cellAt = [&](double s) { return static_cast<float>(std::ceil(s * (cells - 1))); };
    std::vector<std::array<float, 2>> entries;
    for (const Feature& f : m_prepared.tf.features)
        entries.push_back({cellAt(f.a), f.b >= 1 ? static_cast<float>(cells) : cellAt(f.b)});
    return entries;
}

void RayVolume::fillFeatures(PacketScene& s) const {
    s.features = m_features.data();
    s.featureCount = static_cast<int>(m_features.size());
    if (const Feature* only = featureAlone()) {
        s.lowestShown = lowestCode(*only);
        s.highestShown = endCode(*only);
    }
}

void RayVolume::fillLight(const Camera& camera, bool occlusion, PacketLight& l) {
    const double scale = m_geometry.d0() / m_grid->maxCode;
    copy(scale * inVoxels(camera.right()), l.cameraFromGradient[0]);
    copy(scale * inVoxels(camera.trueUp()), l.cameraFromGradient[1]);
    copy(-scale * inVoxels(camera.forward()), l.cameraFromGradient[2]);
    if (!occlusion) return;
    if (!m_openness) m_openness = makeAmbientOcclusion(*m_grid, m_geometry, m_prepared.tf, featureAlone());
    l.openness = m_openness->open.data();
    for (int a = 0; a < 3; ++a) l.opennessDims[a] = m_openness->open.dims()[a];
    l.cellOfVoxel = 1.0f / AmbientOcclusion::kCell;
    l.cellOfVoxelOffset = 0.5f / AmbientOcclusion::kCell - 0.5f;
}

} // namespace pellucid
