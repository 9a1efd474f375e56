// Writes NIfTI in one file, plain or packed by gzip: version 1, and 2 where that cannot count the voxels. The grid is
// placed by sform.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/formats/nifti_form.h"
#include "volume/formats/writer.h"
#include "volume/orientation.h"

namespace pellucid {

namespace {

const Vec3 kFlip{-1, -1, 1}; // its x goes to the right, its y to the front

/// The longest axis of NIfTI-1, and most frames.
constexpr int kMost = std::numeric_limits<std::int16_t>::max();

const NiftiForm& formFor(const FramesToWrite& frames) {
    const Int3& dims = frames.geometry.dims;
    return kNiftiForms[std::max({dims.x, dims.y, dims.z, frames.count}) > kMost ? 1 : 0];
}

/// A header, and the four bytes behind it that say that no extensions follow.
class Header {
public:
    explicit Header(const NiftiForm& form) : m_form(form), m_bytes(form.bytes + 4) {
        put(0, static_cast<std::int32_t>(form.bytes));
        const std::string mark = std::string("n+") + (isWide() ? '2' : '1') + '\0' + (isWide() ? kNifti2Mark : "");
        std::ranges::copy(mark, m_bytes.begin() + static_cast<std::ptrdiff_t>(form.magic));
        if (isWide())
            put(form.voxOffset, static_cast<std::int64_t>(m_bytes.size()));
        else
            put(form.voxOffset, static_cast<float>(m_bytes.size()));
    }
    template <class T>
    void put(std::size_t at, T value) {
        std::memcpy(m_bytes.data() + at, &value, sizeof value);
    }
    /// The i-th number of a field.
    void putReal(std::size_t field, double value, std::size_t i = 0) {
        if (isWide())
            put(field + i * sizeof(double), value);
        else
            put(field + i * sizeof(float), static_cast<float>(value));
    }
    void putDim(std::size_t i, int value) {
        if (isWide())
            put(m_form.dim + i * sizeof(std::int64_t), static_cast<std::int64_t>(value));
        else
            put(m_form.dim + i * sizeof(std::int16_t), static_cast<std::int16_t>(value));
    }
    void putCode(std::size_t field, int value) {
        if (isWide())
            put(field, static_cast<std::int32_t>(value));
        else
            put(field, static_cast<std::int16_t>(value));
    }
    void putUnits(int value) {
        if (isWide())
            put(m_form.units, static_cast<std::int32_t>(value));
        else
            put(m_form.units, static_cast<char>(value));
    }
    const std::vector<char>& bytes() const { return m_bytes; }

private:
    bool isWide() const { return m_form.version == 2; }
    const NiftiForm& m_form;
    std::vector<char> m_bytes;
};

/// The code of a unit of time; 0: there is none for it.
int timeCode(const std::string& unit) { return unit == "s" ? 8 : unit == "ms" ? 16 : unit == "µs" ? 24 : 0; }

/// The code of a unit of length, likewise.
int lengthCode(LengthUnit unit) {
    return unit == LengthUnit::Metre ? 1 : unit == LengthUnit::Millimetre ? 2 : unit == LengthUnit::Micrometre ? 3 : 0;
}

/// In a unit that there is a code for.
Geometry inUnitOfNifti(const Geometry& g) {
    const LengthUnit unit = unitOf(g);
    if (unit == LengthUnit::Unknown || lengthCode(unit) != 0) return g;
    const bool isSmall = converted(1, unit, LengthUnit::Micrometre) < 1;
    return inUnit(g, isSmall ? LengthUnit::Micrometre : LengthUnit::Millimetre);
}

/// Row by row, 3 x 4.
void placeGrid(Header& header, const NiftiForm& form, const Geometry& g) {
    header.putCode(form.sformCode, 1);
    for (int row = 0; row < 3; ++row) {
        const std::size_t at = 4 * static_cast<std::size_t>(row);
        for (int column = 0; column < 3; ++column)
            header.putReal(form.sform, kFlip[row] * g.directions[column][row] * g.spacing[column],
                           at + static_cast<std::size_t>(column));
        header.putReal(form.sform, kFlip[row] * g.origin[row], at + 3);
    }
}

Header headerOf(const FramesToWrite& frames) {
    struct Type {
        std::int16_t code, bits;
    };
    constexpr Type kTypes[] = {{2, 8}, {256, 8}, {512, 16}, {4, 16}, {768, 32}, {8, 32}, {16, 32}, {64, 64}};
    const Geometry g = inUnitOfNifti(frames.geometry);
    const Type type = kTypes[static_cast<std::size_t>(frames.type)];
    const bool several = frames.count > 1;
    const NiftiForm& form = formFor(frames);
    Header header(form);
    header.putDim(0, several ? 4 : 3);
    for (std::size_t a = 1; a <= 7; ++a)
        header.putDim(a, a < 4 ? g.dims[static_cast<int>(a) - 1] : a == 4 ? frames.count : 1);
    header.put(form.datatype, type.code);
    header.put(form.bitpix, type.bits);
    header.putReal(form.pixdim, 1);
    for (int a = 0; a < 3; ++a) header.putReal(form.pixdim, g.spacing[a], static_cast<std::size_t>(a) + 1);
    if (several) header.putReal(form.pixdim, frames.times ? frames.times->width : 1, 4);
    if (several && frames.times) header.putReal(form.timeOffset, frames.times->first);
    header.putReal(form.slope, 1);
    header.putUnits(lengthCode(unitOf(g)) + (several && frames.times ? timeCode(frames.times->unit) : 0));
    const bool isTurned = g.directions != Mat3(1) || g.origin != Vec3(0);
    if (g.worldAxes == WorldAxes::Patient || isTurned) placeGrid(header, form, g);
    return header;
}

void write(const FramesToWrite& frames, const std::string& path, const JobControl& job) {
    const Header header = headerOf(frames);
    writeAtomically(path, [&](OutputFile& out) {
        if (lowerCase(path).ends_with(".gz"))
            return deflateFrames(out, std::as_bytes(std::span(header.bytes())), frames, job);
        out.write(header.bytes().data(), header.bytes().size());
        writeFrames(out, frames, job);
    });
}

bool isFloat(double value) { return static_cast<double>(static_cast<float>(value)) == value; }

std::vector<std::string> losses(const FramesToWrite& frames, const std::string&) {
    const Geometry g = inUnitOfNifti(frames.geometry);
    const bool isWide = formFor(frames).version == 2;
    std::vector<std::string> lost;
    if (isWide)
        lost.push_back(
            "NIfTI-1 has at most " + std::to_string(kMost) +
            " voxels along an axis, and as many frames: the file is NIfTI-2, which older programs do not read");
    const auto isKept = [&](double value) { return isWide || isFloat(value); }; // it has double precision
    bool isExact = true;
    for (int a = 0; a < 3; ++a) isExact = isExact && isKept(g.spacing[a]) && isKept(g.origin[a]);
    if (!isExact) lost.emplace_back("NIfTI keeps spacing and origin to seven digits");
    const bool isTurned = g.directions != Mat3(1) || g.origin != Vec3(0);
    if (g.worldAxes == WorldAxes::File && isTurned)
        lost.emplace_back("NIfTI takes every place for one of a patient: the file will be read as such");
    if (unitOf(g) != unitOf(frames.geometry))
        lost.push_back(std::string("NIfTI cannot state lengths in ") + lengthUnit(frames.geometry) +
                       ": they are converted to " + lengthUnit(g));
    if (!frames.times) return lost;
    if (!isKept(frames.times->width) || !isKept(frames.times->first))
        lost.emplace_back("NIfTI keeps times to seven digits");
    if (!frames.times->unit.empty() && timeCode(frames.times->unit) == 0)
        lost.push_back("NIfTI knows no unit of time called " + inQuotes(frames.times->unit));
    return lost;
}

} // namespace

VolumeWriter niftiWriter() { return {"NIfTI", {".nii", ".nii.gz"}, write, losses}; }

} // namespace pellucid
