#include "volume/derived.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <set>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/enum_names.h"
#include "base/error.h"
#include "base/text.h"
#include "volume/orientation.h"
#include "volume/voxel_loops.h"

namespace pellucid {

template <>
inline constexpr auto kNamesOf<Derivation::Kind> = enumNames("derivation", "gradient", "volatility", "difference");

std::string Derivation::text() const {
    const std::string named = std::string(name(kind)) + ":" + of;
    if (kind == Kind::Gradient) return named;
    return named + ":" + std::to_string(kind == Kind::Volatility ? frames : reference);
}

std::optional<Derivation> parseDerivation(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return {};
    const auto kind = findNamed<Derivation::Kind>(text.substr(0, colon));
    if (!kind) return {};
    Derivation d;
    d.kind = *kind;
    const auto fail = [&](const std::string& what) {
        return UsageError(what, "variable " + text,
                          "give gradient:NAME, volatility:NAME:FRAMES or difference:NAME:FRAME");
    };
    d.of = text.substr(colon + 1);
    if (d.kind != Derivation::Kind::Gradient) {
        // What it is made of may be derived itself: the number is what stands last.
        const std::size_t last = d.of.rfind(':');
        std::int64_t number = 0;
        if (last == std::string::npos || !parseNumber(d.of.substr(last + 1), number)) throw fail("it has no number");
        constexpr std::int64_t kMost = 1'000'000'000;
        const bool volatility = d.kind == Derivation::Kind::Volatility;
        if (number < (volatility ? 1 : 0) || number > kMost) throw fail("the number is out of range");
        (volatility ? d.frames : d.reference) = static_cast<int>(number);
        d.of.resize(last);
    }
    if (d.of.empty()) throw fail("it names no variable");
    return d;
}

namespace {

/// Normalised by a range over all frames, [0,1]; NaN where invalid.
class Normaliser {
public:
    explicit Normaliser(const ValueRange& range)
        : m_lo(range.lo), m_scale(range.lo < range.hi ? 1 / (range.hi - range.lo) : 0) {}
    double operator()(double value) const { return std::clamp((value - m_lo) * m_scale, 0.0, 1.0); }
    double scale() const { return m_scale; }

private:
    double m_lo, m_scale;
};

constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();

/// Floats voxel by voxel: valueOf(values, index) of each valid voxel, k on any thread.
template <class ValueOf>
std::vector<float> mapped(const Volume& volume, const JobControl& job, const ValueOf& valueOf) {
    std::vector<float> out(volume.size());
    const bool allValid = volume.invalidCount() == 0;
    forEachVoxel(volume, job, [&](const auto& values, std::size_t i) {
        out[i] = allValid || volume.isValid(i) ? static_cast<float>(valueOf(values, i)) : kInvalid;
    });
    return out;
}

Volume derivedVolume(const Geometry& geometry, std::vector<float> values, const std::string& title) {
    Volume volume(geometry, SampleArray<float>(std::move(values)));
    volume.title = title;
    volume.format = "derived";
    return volume;
}

// ---- gradient magnitude

std::vector<float> gradientOf(const Volume& volume, const ValueRange& range, const JobControl& job) {
    const Geometry& g = volume.geometry();
    const Int3 n = g.dims;
    const Mat3 toWorld = glm::transpose(g.indexFromWorld()); // ∂/∂world of ∂/∂index
    const double scale = Normaliser(range).scale() * g.d0();
    const std::array<std::size_t, 3> step{1, static_cast<std::size_t>(n.x), layerSize(n)};
    const bool allValid = volume.invalidCount() == 0;
    return mapped(volume, job, [&](const auto& values, std::size_t i) {
        const std::array<std::size_t, 3> at{i % step[1], i / step[1] % static_cast<std::size_t>(n.y), i / step[2]};
        Vec3 slope(0);
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            // Central, one-sided where there is a neighbour on one side only.
            std::size_t lower = at[axis] > 0 ? i - step[axis] : i;
            std::size_t upper = at[axis] + 1 < static_cast<std::size_t>(n[a]) ? i + step[axis] : i;
            if (!allValid) {
                if (!volume.isValid(lower)) lower = i;
                if (!volume.isValid(upper)) upper = i;
            }
            if (lower == upper) continue;
            const double distance = upper - lower == 2 * step[axis] ? 2 : 1;
            slope[a] = (static_cast<double>(values[upper]) - static_cast<double>(values[lower])) / distance;
        }
        return glm::length(toWorld * slope) * scale;
    });
}

// ---- difference

std::vector<float> differenceOf(const Volume& from, const Volume& to, const JobControl& job) {
    return mapped(to, job, [&](const auto& values, std::size_t i) {
        const double difference = static_cast<double>(values[i]) - from.value(i);
        return from.isValid(i) ? difference : static_cast<double>(kInvalid);
    });
}

// ---- volatility

/// Sums over the latest frames of normalised values in whole units of 2⁻²⁴ (2⁻²⁰ of many frames), so that they are
/// exact: what was added and taken away again leaves no trace, and every way to a frame gives the same bits.
class VolatilitySums {
public:
    VolatilitySums(std::shared_ptr<TimeSeries> base, int frames, VolatilityKind kind)
        : m_base(std::move(base)), m_frames(frames), m_units(frames <= 128 ? 1 << 24 : 1 << 20), m_kind(kind) {}

    /// `present`: the frame itself.
    std::vector<float> at(const Volume& present, int frame, const JobControl& job) {
        const std::lock_guard lock(m_mutex);
        // Published, each frame is normalised by itself, and no other has to be read for that.
        const ValueRange range = isPublished() ? ValueRange{0, 1} : m_base->range(job);
        if (!(range == m_range) || m_sums.size() != present.size()) reset(range, present.size());
        const int first = std::max(0, frame - m_frames + 1);
        int kept = 0;
        for (const int f : m_in) kept += f >= first && f <= frame ? 1 : 0;
        const int leaving = static_cast<int>(m_in.size()) - kept, wanted = frame - first + 1;
        if (leaving + wanted - kept >= wanted) reset(range, present.size());
        try {
            for (const int f : std::set<int>(m_in))
                if (f < first || f > frame) change(f, -1, job);
            for (int f = first; f <= frame; ++f)
                if (!m_in.contains(f)) change(f, +1, job);
        } catch (const Cancelled&) {
            reset(range, present.size()); // half of a frame may be in
            throw;
        }
        std::vector<float> values = deviations(present.dims());
        if (isPublished()) stretch(values);
        return values;
    }

private:
    bool isPublished() const { return m_kind == VolatilityKind::Published; }

    struct Sums {
        std::int64_t sum = 0, squares = 0;
    };

    void reset(const ValueRange& range, std::size_t size) {
        m_range = range;
        m_in.clear();
        m_sums.assign(size, {});
        m_invalid.clear();
    }

    void change(int frame, int sign, const JobControl& job) {
        std::shared_ptr<const Volume> volume;
        try {
            volume = m_base->load(frame, job);
        } catch (const Error&) {
            return; // its maker tells; the deviation is that of the others
        }
        const Normaliser normalised(isPublished() ? volume->dataRange() : m_range);
        const bool allValid = volume->invalidCount() == 0;
        if (!allValid && m_invalid.empty()) m_invalid.assign(volume->size(), 0);
        forEachVoxel(*volume, {}, [&](const auto& values, std::size_t i) {
            if (!allValid && !volume->isValid(i)) {
                m_invalid[i] = static_cast<std::uint16_t>(m_invalid[i] + sign);
                return;
            }
            const auto q = static_cast<std::int64_t>(normalised(static_cast<double>(values[i])) * m_units + 0.5);
            m_sums[i].sum += sign * q;
            m_sums[i].squares += sign * q * q;
        });
        if (sign > 0)
            m_in.insert(frame);
        else
            m_in.erase(frame);
    }

    std::vector<float> deviations(const Int3& dims) const {
        std::vector<float> out(m_sums.size());
        const auto n = static_cast<std::int64_t>(m_in.size());
        const double count = static_cast<double>(n);
        const double scale = 1.0 / ((isPublished() ? std::sqrt(count * std::max(1.0, count - 1)) : count) * m_units);
        forEachPlace(dims, {}, [&](const Int3&, std::size_t i) {
            const Sums& s = m_sums[i];
            // n·Σq² and (Σq)² are below n²·2⁴⁸ (n²·2⁴⁰): they fit.
            const double deviation = std::sqrt(static_cast<double>(n * s.squares - s.sum * s.sum)) * scale;
            out[i] = !m_invalid.empty() && m_invalid[i] > 0 ? kInvalid : static_cast<float>(deviation);
        });
        return out;
    }

    /// The least is 0 and the largest 1 then; where all are one, 0.
    static void stretch(std::vector<float>& values) {
        float lo = std::numeric_limits<float>::infinity(), hi = -lo;
        for (const float v : values)
            if (!std::isnan(v)) {
                lo = std::min(lo, v);
                hi = std::max(hi, v);
            }
        for (float& v : values)
            if (!std::isnan(v)) v = hi > lo ? (v - lo) / (hi - lo) : 0.0f;
    }

    const std::shared_ptr<TimeSeries> m_base;
    const int m_frames;
    const int m_units;
    const VolatilityKind m_kind;
    std::mutex m_mutex;
    ValueRange m_range{0, 0};
    std::set<int> m_in; // frames that the sums are of
    std::vector<Sums> m_sums;
    std::vector<std::uint16_t> m_invalid; // frames in which a voxel is invalid; empty: none is
};

constexpr int kMostFrames = 2048; // so that sums of squares fit

} // namespace

std::shared_ptr<TimeSeries> derive(std::shared_ptr<TimeSeries> base, const Derivation& derivation,
                                   const JobControl& job, VolatilityKind volatility) {
    SeriesListing listing = base->listing();
    const std::string title = derivation.text();
    listing.title = title;
    listing.declaredRange.reset();
    listing.notices.clear();
    std::function<std::vector<float>(const Volume& present, int frame, const JobControl&)> valuesOf;
    switch (derivation.kind) {
    case Derivation::Kind::Gradient:
        valuesOf = [base](const Volume& present, int, const JobControl& loading) {
            return gradientOf(present, base->range(loading), loading);
        };
        break;
    case Derivation::Kind::Volatility:
        if (derivation.frames < 1 || derivation.frames > kMostFrames)
            throw UsageError("volatility of " + std::to_string(derivation.frames) + " frames", "variable " + title,
                             "give 1 to " + std::to_string(kMostFrames) + " frames");
        if (volatility == VolatilityKind::Published) listing.declaredRange = ValueRange{0, 1};
        valuesOf = [sums = std::make_shared<VolatilitySums>(base, derivation.frames, volatility)](
                       const Volume& present, int frame, const JobControl& loading) {
            return sums->at(present, frame, loading);
        };
        break;
    case Derivation::Kind::Difference:
        if (derivation.reference >= base->size())
            throw UsageError("the series has no frame " + std::to_string(derivation.reference), "variable " + title,
                             "give 0 to " + std::to_string(base->size() - 1));
        if (base->varies()) { // zero in the middle
            const ValueRange range = base->range({job.stop, {}});
            listing.declaredRange = ValueRange{range.lo - range.hi, range.hi - range.lo};
        }
        valuesOf = [base, reference = derivation.reference](const Volume& present, int, const JobControl& loading) {
            return differenceOf(*base->load(reference, loading), present, loading);
        };
        break;
    }
    return std::make_shared<TimeSeries>(
        std::move(listing), [base, title, valuesOf](int frame, const JobControl& loading) {
            const std::shared_ptr<const Volume> present = base->load(frame, loading);
            return derivedVolume(present->geometry(), valuesOf(*present, frame, loading), title);
        });
}

// ---- grids

bool onSameGrid(const Geometry& a, const Geometry& b) {
    const auto near = [](const Vec3& p, const Vec3& q, double scale) {
        return std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z) <= 1e-6 * scale;
    };
    return a.dims == b.dims && near(a.spacing, b.spacing, a.d0()) && near(a.origin, b.origin, a.radius()) &&
           near(a.directions[0], b.directions[0], 1) && near(a.directions[1], b.directions[1], 1) &&
           near(a.directions[2], b.directions[2], 1);
}

Volume resampledTo(const Volume& volume, const Geometry& grid, const JobControl& job) {
    const Geometry from = inUnit(volume.geometry(), unitOf(grid));
    const Int3 n = from.dims;
    const Vec3 lo = from.voxelBoxMin(), hi = from.voxelBoxMax();
    std::vector<float> out(voxelCount(grid.dims), kInvalid);
    const bool allValid = volume.invalidCount() == 0;
    withSamples(volume, [&](const auto& values) {
        forEachPlace(grid.dims, job, [&](const Int3& place, std::size_t index) {
            const Vec3 at = from.voxelFromWorld(grid.worldFromVoxel(place));
            if (at.x < lo.x || at.y < lo.y || at.z < lo.z || at.x > hi.x || at.y > hi.y || at.z > hi.z) return;
            double sum = 0, weight = 0;
            for (unsigned corner = 0; corner < 8; ++corner) {
                double w = 1;
                std::size_t voxel = 0, stride = 1;
                for (int a = 0; a < 3; ++a) {
                    const double p = std::clamp(at[a], 0.0, n[a] - 1.0);
                    const int base = std::min(static_cast<int>(p), std::max(0, n[a] - 2));
                    const bool upper = (corner >> a) & 1u;
                    w *= upper ? p - base : 1 - (p - base);
                    voxel += stride * static_cast<std::size_t>(std::min(base + (upper ? 1 : 0), n[a] - 1));
                    stride *= static_cast<std::size_t>(n[a]);
                }
                if (w == 0 || (!allValid && !volume.isValid(voxel))) continue;
                sum += w * static_cast<double>(values[voxel]);
                weight += w;
            }
            if (weight > 0) out[index] = static_cast<float>(sum / weight);
        });
    });
    return derivedVolume(grid, std::move(out), volume.title);
}

} // namespace pellucid
