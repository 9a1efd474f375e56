#include "share/scene_block.h"

#include <nlohmann/json.hpp>

#include "render/ambient_occlusion.h"
#include "tf/shown_tf.h"

namespace pellucid {

namespace {

using nlohmann::json;

json jsonOf(const Vec3& v) { return {v.x, v.y, v.z}; }
json jsonOf(const Int3& v) { return {v.x, v.y, v.z}; }
json jsonOf(const Rgb& c) { return {c.r, c.g, c.b}; }

/// Voxels of the whole along each axis that are one of the coarser volume.
Vec3 factors(const SceneBlock& b) { return Vec3(glm::min(Int3(b.factor), b.scene.volume->dims())); }

json volumeJson(const SceneBlock& b) {
    const Geometry &g = b.volume.geometry(), &whole = b.scene.volume->geometry();
    const Mat3 axes = g.worldFromIndex();
    return {{"dims", jsonOf(g.dims)},
            {"full_dims", jsonOf(whole.dims)},
            {"factor", b.factor},
            {"bits", b.codes.bits},
            {"max_code", b.codes.maxCode},
            {"exact", b.codes.exact},
            {"has_invalid", b.volume.invalidCount() > 0},
            {"axes", json::array({jsonOf(Vec3(axes[0])), jsonOf(Vec3(axes[1])), jsonOf(Vec3(axes[2]))})},
            {"origin", jsonOf(g.origin)},
            {"center", jsonOf(whole.boxCenter())},
            {"radius", whole.radius()},
            {"d0", whole.d0()},
            {"window", {b.scene.volume->range().lo, b.scene.volume->range().hi}}};
}

json tfJson(const SceneBlock& b) {
    const TransferFunction& tf = b.scene.tf;
    json points = json::array(), features = json::array();
    for (const ControlPoint& p : tf.pointsWithEnds())
        points.push_back({p.x, p.opacity, p.color.r, p.color.g, p.color.b});
    const std::vector<double> opacities = featureOpacities(tf);
    const int only = b.look.onlyFeature;
    for (std::size_t f = 0; f < tf.features.size(); ++f) {
        const Feature& feature = tf.features[f];
        json one{{"name", printable(feature.name)},
                 {"range", {feature.a, feature.b}},
                 {"color", jsonOf(feature.color)},
                 {"opacity", opacities[f]},
                 {"hidden", feature.hidden || (only >= 0 && only != static_cast<int>(f))}};
        if (f < b.figures.features.size()) {
            one["vws"] = b.figures.features[f].vws;
            one["visibility"] = b.figures.features[f].visibility;
        }
        features.push_back(std::move(one));
    }
    return {{"points", std::move(points)}, {"features", std::move(features)}, {"only", only}};
}

json lightJson(const Light& light) {
    return {{"on", light.on},
            {"ambient", light.ambient},
            {"diffuse", light.diffuse},
            {"specular", light.specular},
            {"shininess", light.shininess},
            {"direction", jsonOf(light.direction)},
            {"gradient_opacity", light.gradientOpacity},
            {"occlusion", light.occlusion},
            {"depth_cue", light.depthCue},
            {"silhouettes", light.silhouettes}};
}

/// The same half-spaces among the voxels of the coarser volume: voxel v of it has its centre at f·(v + ½) − ½.
json planesJson(const std::vector<VoxelPlane>& planes, const Vec3& f) {
    json all = json::array();
    for (const VoxelPlane& p : planes) {
        const Vec3 normal = p.normal * f;
        const Vec3 shift = p.normal * (0.5 * f - 0.5);
        all.push_back({normal.x, normal.y, normal.z, p.offset - (shift.x + shift.y + shift.z)});
    }
    return all;
}

json viewJson(const SceneBlock& b) {
    const Vec3 f = factors(b), ratio = Vec3(b.scene.volume->dims()) / (f * Vec3(b.volume.dims()));
    const Clipping& clipping = b.look.clipping;
    BoxPart oblique;
    oblique.planes = clipping.planes;
    const Geometry& whole = b.scene.volume->geometry();
    json view{{"background", jsonOf(*b.look.background)},
              {"background_top", jsonOf(b.look.backgroundTop.value_or(*b.look.background))},
              {"step", b.look.stepInD0},
              {"halvings", b.look.halvings()},
              {"light", lightJson(b.look.light)},
              {"clip",
               {{"lo", jsonOf(clipping.lo * ratio)},
                {"hi", jsonOf(clipping.hi * ratio)},
                {"planes", planesJson(planesInVoxels(oblique, whole), f)}}}};
    if (!clipping.rest.isNone())
        view["faint"] = {{"planes", planesJson(planesInVoxels(clipping.rest.within, whole), f)},
                         {"density", clipping.rest.density}};
    return view;
}

json densityJson(const DensityCurve& curve, const TransferFunction& tf) {
    json points = json::array();
    for (const DensityPoint& p : curve.points)
        points.push_back({{"coverage", p.coverage.coverage}, {"opacity", p.opacity}});
    return {{"points", std::move(points)}, {"at", curve.nearest(featureOpacities(shownTf(tf))).coverage}};
}

} // namespace

json jsonOf(const SceneBlock& b) {
    json all{{"format", "pellucid-page"},
             {"version", 1},
             {"title", printable(b.title)},
             {"volume", volumeJson(b)},
             {"data", {{"packed", b.packedBytes}}},
             {"camera", jsonFromCamera(b.scene.camera)},
             {"tf", tfJson(b)},
             {"view", viewJson(b)}};
    if (b.figures.curve) all["density"] = densityJson(*b.figures.curve, b.scene.tf);
    if (b.openness) all["openness"] = {{"dims", jsonOf(*b.openness)}, {"cell", AmbientOcclusion::kCell}};
    return all;
}

} // namespace pellucid
