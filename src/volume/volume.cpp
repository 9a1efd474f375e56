#include "volume/volume.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

struct Statistics {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -std::numeric_limits<double>::infinity();
    std::size_t invalid = 0;
};

bool valid(double value, std::optional<double> missing) {
    return std::isfinite(value) && !(missing && value == *missing);
}

Statistics statisticsOf(const Samples& samples, std::optional<double> missing) {
    return std::visit(
        [&](const auto& values) {
            constexpr std::size_t kBlock = 1u << 20;
            std::vector<Statistics> blocks((values.size() + kBlock - 1) / kBlock);
            parallelFor(blocks.size(), [&](std::size_t b) {
                Statistics s;
                const std::size_t end = std::min(values.size(), (b + 1) * kBlock);
                using T = typename std::decay_t<decltype(values)>::value_type;
                if (std::is_integral_v<T> && !missing) { // all are valid, and vectors compare whole numbers quickest
                    T lo = std::numeric_limits<T>::max(), hi = std::numeric_limits<T>::lowest();
                    for (std::size_t i = b * kBlock; i < end; ++i) {
                        lo = std::min(lo, values[i]);
                        hi = std::max(hi, values[i]);
                    }
                    blocks[b] = {static_cast<double>(lo), static_cast<double>(hi), 0};
                    return;
                }
                for (std::size_t i = b * kBlock; i < end; ++i) {
                    const double v = static_cast<double>(values[i]);
                    if (!valid(v, missing)) {
                        ++s.invalid;
                        continue;
                    }
                    s.lo = std::min(s.lo, v);
                    s.hi = std::max(s.hi, v);
                }
                blocks[b] = s;
            });
            Statistics all;
            for (const Statistics& s : blocks) {
                all.lo = std::min(all.lo, s.lo);
                all.hi = std::max(all.hi, s.hi);
                all.invalid += s.invalid;
            }
            return all;
        },
        samples);
}

} // namespace

Mat3 Geometry::worldFromIndex() const {
    return {directions[0] * spacing.x, directions[1] * spacing.y, directions[2] * spacing.z};
}

Mat3 Geometry::indexFromWorld() const { return glm::inverse(worldFromIndex()); }

Vec3 Geometry::voxelFromWorld(const Vec3& world) const { return glm::inverse(directions) * (world - origin) / spacing; }

Vec3 Geometry::corner(int n) const {
    const Vec3 lo = voxelBoxMin(), hi = voxelBoxMax();
    return worldFromVoxel({(n & 1) != 0 ? hi.x : lo.x, (n & 2) != 0 ? hi.y : lo.y, (n & 4) != 0 ? hi.z : lo.z});
}

Vec3 Geometry::boxCenter() const { return worldFromVoxel(0.5 * (Vec3(dims) - 1.0)); }

double Geometry::radius() const {
    double longest = 0;
    for (int n = 0; n < 4; ++n) longest = std::max(longest, glm::length(corner(n) - corner(7 - n)));
    return 0.5 * longest;
}

Vec3 Geometry::boundsMin() const {
    Vec3 lo = corner(0);
    for (int n = 1; n < 8; ++n) lo = glm::min(lo, corner(n));
    return lo;
}

Vec3 Geometry::boundsMax() const {
    Vec3 hi = corner(0);
    for (int n = 1; n < 8; ++n) hi = glm::max(hi, corner(n));
    return hi;
}

bool Geometry::contains(const Vec3& world) const {
    const Vec3 p = voxelFromWorld(world), lo = voxelBoxMin(), hi = voxelBoxMax();
    return p.x > lo.x && p.y > lo.y && p.z > lo.z && p.x < hi.x && p.y < hi.y && p.z < hi.z;
}

namespace {

void requireSound(const Geometry& geometry) {
    const Int3 d = geometry.dims;
    if (d.x < 1 || d.y < 1 || d.z < 1) throw Error("a volume needs at least one voxel along each axis", "", "");
    if (const std::string wrong = geometryProblem(geometry.spacing, geometry.origin); !wrong.empty())
        throw Error(wrong, "", "correct the header", Remedy::GiveSpacing);
    constexpr double kFlat = 1e-6; // of the volume that three axes of length 1 span
    bool unit = true;
    for (int a = 0; a < 3; ++a) unit = unit && std::abs(glm::length(geometry.directions[a]) - 1) < 1e-6;
    if (!unit || !(std::abs(glm::determinant(geometry.directions)) > kFlat))
        throw Error("the axes of the grid lie in one plane, or are no directions", "", "correct the header");
}

} // namespace

Volume::Volume(const Geometry& geometry, Samples samples, std::optional<double> missing)
    : m_geometry(geometry), m_type(static_cast<SampleType>(samples.index())), m_missing(missing) {
    requireSound(geometry);
    const std::size_t count = std::visit([](const auto& v) { return v.size(); }, samples);
    if (count != voxelCount(geometry.dims)) throw Error("number of samples and dimensions disagree", "", "");
    m_samples = std::make_shared<const Samples>(std::move(samples));
    // −999.9 written as a decimal is not the float that the file holds for it.
    if (m_missing && sampleType() == SampleType::F32) m_missing = static_cast<double>(static_cast<float>(*m_missing));
    const Statistics s = statisticsOf(*m_samples, m_missing);
    m_invalidCount = s.invalid;
    m_range = m_dataRange = s.invalid < count ? ValueRange{s.lo, s.hi} : ValueRange{0, 0};
}

Volume::Volume(const Geometry& geometry, Distributed parts)
    : m_geometry(geometry), m_type(parts.type), m_here(std::move(parts.here)), m_elsewhere(std::move(parts.elsewhere)),
      m_missing(parts.missing), m_dataRange(parts.dataRange), m_range(parts.dataRange),
      m_invalidCount(parts.invalidCount) {
    requireSound(geometry);
    PELLUCID_CHECK(m_elsewhere != nullptr);
}

const Samples& Volume::samples() const {
    if (!m_samples)
        throw Error("the voxels lie on several ranks, and this asks for all of them at once", title,
                    "do it in one process, with pellucid-cli");
    return *m_samples;
}

Volume Volume::withRange(const ValueRange& range) const {
    if (!std::isfinite(range.lo) || !std::isfinite(range.hi) || !(range.lo < range.hi))
        throw UsageError("the intensity range needs LO < HI, both finite", "intensity range",
                         "give two such numbers, in data units");
    Volume other = *this;
    other.m_range = range;
    if (m_here) other.m_here = std::make_shared<const Volume>(m_here->withRange(range));
    other.m_codes = std::make_shared<SharedCodes>();
    return other;
}

Volume Volume::withGeometry(const Geometry& geometry) const {
    PELLUCID_CHECK(geometry.dims == m_geometry.dims);
    if (m_elsewhere) static_cast<void>(samples()); // says that it cannot be done
    Volume other = *this;
    other.m_geometry = geometry;
    other.m_codes = std::make_shared<SharedCodes>();
    return other;
}

double Volume::value(std::size_t index) const {
    return std::visit([index](const auto& v) { return static_cast<double>(v[index]); }, samples());
}

bool Volume::isValid(std::size_t index) const { return valid(value(index), m_missing); }

double Volume::intensity(std::size_t index) const { return intensityOfValue(value(index)); }

double Volume::intensityOfValue(double v) const {
    if (!valid(v, m_missing)) return std::numeric_limits<double>::quiet_NaN();
    if (m_range.lo == m_range.hi) return 0.0;
    const double span = m_range.hi - m_range.lo;
    // The ends may lie further apart than the largest double; halves of them do not.
    if (std::isinf(span)) return std::clamp((v / 2 - m_range.lo / 2) / (m_range.hi / 2 - m_range.lo / 2), 0.0, 1.0);
    return std::clamp((v - m_range.lo) / span, 0.0, 1.0);
}

} // namespace pellucid
