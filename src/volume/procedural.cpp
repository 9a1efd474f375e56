#include "volume/procedural.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "volume/formats/file_check.h"
#include "volume/noise.h"
#include "volume/samples/time_samples.h"

namespace pellucid {

namespace {

/// Fills a grid slice by slice: valueAt(i, j, k), k on any thread.
template <class T, class ValueAt>
std::vector<T> fill(const Int3& dims, const JobControl& job, const ValueAt& valueAt) {
    std::vector<T> values(voxelCount(dims));
    std::atomic<int> done = 0;
    parallelFor(static_cast<std::size_t>(dims.z), [&](std::size_t k) {
        job.throwIfStopped();
        T* out = values.data() + k * layerSize(dims);
        for (int j = 0; j < dims.y; ++j)
            for (int i = 0; i < dims.x; ++i) *out++ = valueAt(i, j, static_cast<int>(k));
        job.report(static_cast<double>(++done) / dims.z);
    });
    return values;
}

template <class T>
T rounded(double value, double lo, double hi) {
    return static_cast<T>(std::lround(std::clamp(value, lo, hi)));
}

// ---------------------------------------------------------------- disks

/// Three solid disks one behind the other along x (fig. 4.1), hard edges: no voxel between two intensities, so that
/// no disk has a skin of another feature's colour. Values 42, 126, 210 of the window 0 … 252 are the intensities
/// 1/6, 1/2, 5/6 exactly, the centres of three tents.
Volume makeDisks(const Geometry& geometry, const SampleOrder&, const JobControl& job) {
    const Int3 d = geometry.dims;
    auto values = fill<std::uint8_t>(d, job, [&](int i, int j, int k) -> std::uint8_t {
        const Vec3 p = (Vec3(i, j, k) + 0.5) / Vec3(d) - 0.5; // [−½, ½]
        if (p.y * p.y + p.z * p.z > 0.36 * 0.36) return 0;
        constexpr double kHalfThickness = 0.0625, kDistance = 0.25;
        for (int disk = 0; disk < 3; ++disk) {
            const double along = p.x - kDistance * (disk - 1);
            // Half open: at least one voxel plane in the smallest size.
            if (along >= -kHalfThickness && along < kHalfThickness) return static_cast<std::uint8_t>(42 + 84 * disk);
        }
        return 0;
    });
    return Volume(geometry, std::move(values)).withRange({0, 252});
}

// ---------------------------------------------------------------- shells

/// Intensity of `shells` at p in [−1, 1]³: a two-lobed core inside a middle and an outer shell, plateaus at the centres
/// of three tents with soft noise on them, joined over a distance `blur`.
double shellsIntensity(const Vec3& p, double blur, std::uint32_t seed) {
    const double r = glm::length(p);
    const Vec3 n = r > 0 ? p / r : Vec3(0, 0, 1);
    const double ripple = 0.6 * smoothNoise(p * 3.0, seed) + 0.3 * smoothNoise(p * 7.0, seed + 1);
    // Low harmonics of the direction, another for each shell.
    const double outer = 0.78 + 0.14 * 5.2 * n.x * n.y * n.z + 0.03 * ripple;
    const double middle = 0.54 + 0.10 * (n.x * n.x - n.y * n.y) - 0.08 * n.z * n.z + 0.04 * ripple;
    const double core = 0.22 + 0.14 * n.x * n.x + 0.03 * ripple;
    const auto inside = [&](double radius) { return 1.0 - smoothStep(radius - blur, radius + blur, r); };
    const double grain = 0.05 * ripple + 0.03 * smoothNoise(p * 16.0, seed + 2);
    const double plateaus = inside(outer) / 6 + inside(middle) / 3 + inside(core) / 3;
    // The heart of the core reaches 1, so that the data range is the whole window.
    const double heart = 0.3 * (1 - smoothStep(0.0, 0.2, r));
    return plateaus + grain * inside(outer) + heart;
}

Volume makeShells(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    const Int3 d = geometry.dims;
    const double blur = 2.5 / d.x; // in units of half the box: about 2½ voxels from plateau to plateau
    auto values = fill<std::uint8_t>(d, job, [&](int i, int j, int k) {
        const Vec3 p = (Vec3(i, j, k) + 0.5) / Vec3(d) * 2.0 - 1.0;
        return rounded<std::uint8_t>(255.0 * shellsIntensity(p, blur, order.seed), 0, 255);
    });
    return Volume(geometry, std::move(values)).withRange({0, 255});
}

// ---------------------------------------------------------------- knee

// Distances are in mm and signed: negative inside. Those of ellipsoids are first-order, exact at the surface, which is
// where they decide. x to the right, y to the back, z up; the joint lies at z = 0.

double ellipsoid(const Vec3& p, const Vec3& center, const Vec3& radii) {
    const Vec3 q = (p - center) / radii;
    const double scaled = glm::length(q);
    const double slope = glm::length(q / radii);
    return slope > 0 ? scaled * (scaled - 1) / slope : -std::min({radii.x, radii.y, radii.z});
}

double ellipse(double x, double y, double rx, double ry) {
    const double qx = x / rx, qy = y / ry;
    const double scaled = std::sqrt(qx * qx + qy * qy);
    const double slope = std::sqrt(qx * qx / (rx * rx) + qy * qy / (ry * ry));
    return slope > 0 ? scaled * (scaled - 1) / slope : -std::min(rx, ry);
}

/// Union with the crease between the two rounded over a width of about `radius`.
double blendedUnion(double a, double b, double radius) {
    const double overlap = std::max(radius - std::abs(a - b), 0.0);
    return std::min(a, b) - overlap * overlap / (4 * radius);
}

struct Bone {
    double distance = 0;
    double cortexMm = 0; ///< thickness of the compact bone
};

Bone femur(const Vec3& p) {
    // A shaft that flares toward two condyles; the notch between them stays open at the back and below.
    const double flare = 1 - smoothStep(8, 62, p.z);
    const double shaft = std::max(ellipse(p.x, p.y + 1, 13.5 + 17 * flare, 13 + 6 * flare), 12 - p.z);
    const double medial = ellipsoid(p, {-20, 6, 17}, {15.5, 27, 16});
    const double lateral = ellipsoid(p, {20, 6, 17.5}, {14.5, 26, 16.5});
    const double distance = blendedUnion(blendedUnion(shaft, medial, 8), lateral, 8);
    return {distance, 1.3 + 4.2 * smoothStep(22, 80, p.z)};
}

Bone tibia(const Vec3& p) {
    const double flare = smoothStep(-62, -8, p.z);
    const double shaft = std::max(ellipse(p.x, p.y - 2 - 2 * flare, 12.5 + 23 * flare, 13 + 10 * flare), p.z + 3.0);
    const double tuberosity = ellipsoid(p, {1, -14, -34}, {9, 9, 15});
    const double spine = ellipsoid(p, {0, 5, -3}, {5, 7, 5});
    const double distance = blendedUnion(blendedUnion(shaft, tuberosity, 6), spine, 3);
    return {distance, 1.3 + 4.0 * smoothStep(20, 80, -p.z)};
}

Bone fibula(const Vec3& p) {
    const double head = smoothStep(-45, -20, p.z);
    return {std::max(ellipse(p.x - 34 + 3 * (1 - head), p.y - 20, 5.5 + 4 * head, 5.5 + 4 * head), p.z + 14.0), 1.8};
}

Bone patella(const Vec3& p) { return {ellipsoid(p, {0, -34, 19}, {21, 9.5, 20}), 1.6}; }

struct KneeTissue {
    double air = -1000, skin = 30, fat = -100, muscle = 55, tendon = 110, cancellous = 290, cortical = 1120;
};

/// The phantom's value in Hounsfield units, without noise. `voxel` is the width over which two tissues share a voxel.
double kneeHounsfield(const Vec3& p, double voxel, std::uint32_t seed) {
    constexpr KneeTissue kTissue;
    // The part of a voxel inside a surface at this signed distance.
    const auto inside = [voxel](double distance) { return std::clamp(0.5 - distance / voxel, 0.0, 1.0); };
    const auto mix = [](double a, double b, double share) { return a + (b - a) * share; };

    // Thigh and calf are thicker than the joint.
    const double thigh = smoothStep(10, 110, p.z), calf = smoothStep(-10, -80, p.z);
    const double leg = ellipse(p.x, p.y - 3 * calf + 1, 62 + 16 * thigh + 2 * calf, 49 + 6 * thigh + 2 * calf);
    if (leg > voxel) return kTissue.air;

    double value = mix(kTissue.air, kTissue.skin, inside(leg));
    value = mix(value, kTissue.fat + 12 * smoothNoise(p / 9.0, seed), inside(leg + 1.6));
    const double fatMm = 9 - 3 * calf + 2 * smoothNoise(p / 25.0, seed + 1);
    // Muscle fills the leg but for the fat under the skin, the fat pad below the patella and the hollow behind the
    // knee.
    const double hollow = ellipsoid(p, {0, 44, 6}, {17, 15, 40});
    const double pad = ellipsoid(p, {0, -30, -8}, {17, 12, 11});
    const double muscle = std::max({leg + fatMm, -hollow, -pad});
    if (muscle < voxel) {
        const double fibres = smoothNoise({p.x / 4, p.y / 4, p.z / 30}, seed + 2);
        value = mix(value, kTissue.muscle + 14 * fibres, inside(muscle));
    }
    const double tendon =
        std::max(ellipse(p.x, p.y + 38 - 14 * smoothStep(0, -34, p.z), 13, 3), std::abs(p.z - 15) - 48);
    value = mix(value, kTissue.tendon, inside(tendon));

    for (const Bone& bone : {femur(p), tibia(p), fibula(p), patella(p)}) {
        if (bone.distance > voxel) continue;
        value = mix(value, kTissue.cortical + 60 * smoothNoise(p / 5.0, seed + 3), inside(bone.distance));
        const double within = inside(bone.distance + bone.cortexMm);
        if (within > 0) {
            // The shaft holds marrow (fat), the ends a lattice of fine bone.
            const double marrow = smoothStep(45, 85, std::abs(p.z - 5));
            const double lattice = 90 * smoothNoise(p / 2.2, seed + 4);
            value = mix(value, mix(kTissue.cancellous + lattice, kTissue.fat + 60, marrow), within);
        }
    }
    return value;
}

Volume makeKnee(const Geometry& geometry, const SampleOrder& order, const JobControl& job) {
    constexpr double kNoiseHounsfield = 15;
    const Vec3 center = 0.5 * (geometry.worldFromVoxel(Vec3(0)) + geometry.worldFromVoxel(Vec3(geometry.dims - 1)));
    const double voxel = std::cbrt(geometry.spacing.x * geometry.spacing.y * geometry.spacing.z);
    auto values = fill<std::int16_t>(geometry.dims, job, [&](int i, int j, int k) {
        const double clean = kneeHounsfield(geometry.worldFromVoxel({i, j, k}) - center, voxel, order.seed);
        return rounded<std::int16_t>(clean + kNoiseHounsfield * whiteNoise(i, j, k, order.seed + 5), -1024, 3071);
    });
    return Volume(geometry, std::move(values));
}

// ---------------------------------------------------------------- the list

struct Sample {
    SampleInfo info;
    Volume (*make)(const Geometry&, const SampleOrder&, const JobControl&);
    Vec3 defaultSpacing{1, 1, 1};
};

const std::vector<Sample>& table() {
    constexpr Int3 kMap{160, 160, 32}; // of the hurricane
    static const std::vector<Sample> kTable{
        {{"disks", "three solid disks one behind the other along x, intensities 1/6, 1/2, 5/6 of 0..252", {64, 64, 64}},
         makeDisks},
        {{"shells", "a lobed, noisy core inside two shells, u8", {96, 96, 96}}, makeShells},
        {{"knee", "a CT-like phantom of a knee in Hounsfield units and mm, i16", {379, 229, 305}},
         makeKnee,
         {0.5, 0.5, 0.7}},
        {{"vortex", "the vorticity of a turbulent flow, 100 frames, u8", {128, 128, 128}, kVortexFrames, kVortexRange},
         makeVortex},
        {{"smoke", "rising smoke, 120 frames, f32", {72, 72, 144}, kSmokeFrames, kSmokeRange}, makeSmoke},
        {{"hurricane", "cloud water of a hurricane that reaches land, 48 frames, f32", kMap, kHurricaneFrames,
          kCloudRange},
         makeCloud},
        {{"hurricane/precipitation", "its rain and snow", kMap, kHurricaneFrames, kPrecipitationRange},
         makePrecipitation},
        {{"hurricane/wind", "its wind speed in m/s", kMap, kHurricaneFrames, kWindRange}, makeWind},
        {{"hurricane/ground", "heights of the land under it in m, one layer", {kMap.x, kMap.y, 1}},
         makeHurricaneGround}};
    return kTable;
}

/// The default shape scaled to `size` voxels along its longest axis. Where the spacing means millimetres the physical
/// extent stays; voxels of unit spacing keep it.
Geometry geometryOf(const Sample& sample, int size) {
    const Int3 d = sample.info.defaultDims;
    Geometry geometry{d, sample.defaultSpacing, {0, 0, 0}};
    if (size == 0) return geometry;
    const double scale = static_cast<double>(size) / std::max({d.x, d.y, d.z});
    for (int a = 0; a < 3; ++a) geometry.dims[a] = std::max(1, static_cast<int>(std::lround(d[a] * scale)));
    if (sample.defaultSpacing != Vec3(1)) geometry.spacing = sample.defaultSpacing / scale;
    return geometry;
}

} // namespace

const std::vector<SampleInfo>& samples() {
    static const std::vector<SampleInfo> kInfos = [] {
        std::vector<SampleInfo> infos;
        for (const Sample& sample : table()) infos.push_back(sample.info);
        return infos;
    }();
    return kInfos;
}

namespace {

const Sample& sampleNamed(const std::string& name) {
    for (const Sample& sample : table())
        if (sample.info.name == name) return sample;
    throw UsageError("there is no sample of this name", "sample:" + name,
                     "the samples are " + joined(samples(), ", ", &SampleInfo::name));
}

} // namespace

const SampleInfo& sampleInfo(const std::string& name) { return sampleNamed(name).info; }

Volume makeSample(const std::string& name, int size, std::uint32_t seed, const JobControl& job, const MemoryUse& then,
                  int step) {
    constexpr int kLeast = 8, kMost = 8192;
    const Sample& sample = sampleNamed(name);
    requireIndex("step", step, static_cast<std::uint64_t>(sample.info.frames), "sample:" + name);
    if (size != 0 && (size < kLeast || size > kMost))
        throw UsageError("the size " + std::to_string(size) + " is not possible", "sample:" + name,
                         "give " + std::to_string(kLeast) + " to " + std::to_string(kMost) + " voxels");
    const Geometry geometry = geometryOf(sample, size);
    const std::uint64_t bytes = voxelCount(geometry.dims) * 2; // of 16-bit samples, the largest there are
    requireMemory(then, "sample:" + name, geometry.dims, SampleType::U16, bytes, bytes);
    Volume volume = sample.make(geometry, {seed, step}, job);
    volume.title = name;
    volume.format = "sample";
    return volume;
}

} // namespace pellucid
