// Writes NIfTI-1 in one file, plain or packed by gzip. The grid is placed by sform.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "volume/formats/writer.h"

namespace pellucid {

namespace {

constexpr std::size_t kHeader = 348, kStart = 352;
const Vec3 kFlip{-1, -1, 1}; // its x goes to the right, its y to the front

class Header {
public:
    template <class T>
    void put(std::size_t at, T value) {
        std::memcpy(m_bytes.data() + at, &value, sizeof value);
    }
    const std::array<char, kStart>& bytes() const { return m_bytes; }

private:
    std::array<char, kStart> m_bytes{};
};

/// The code of a unit of time; 0: there is none for it.
int timeCode(const std::string& unit) { return unit == "s" ? 8 : unit == "ms" ? 16 : unit == "µs" ? 24 : 0; }

Header headerOf(const FramesToWrite& frames) {
    struct Type {
        std::int16_t code, bits;
    };
    constexpr Type kTypes[] = {{2, 8}, {256, 8}, {512, 16}, {4, 16}, {768, 32}, {8, 32}, {16, 32}, {64, 64}};
    const Geometry& g = frames.geometry;
    const Type type = kTypes[static_cast<std::size_t>(frames.type)];
    const bool several = frames.count > 1;
    Header header;
    header.put(0, static_cast<std::int32_t>(kHeader));
    header.put(40, static_cast<std::int16_t>(several ? 4 : 3));
    for (int a = 0; a < 7; ++a)
        header.put(42 + 2 * static_cast<std::size_t>(a), static_cast<std::int16_t>(a < 3    ? g.dims[a]
                                                                                   : a == 3 ? frames.count
                                                                                            : 1));
    header.put(70, type.code);
    header.put(72, type.bits);
    header.put(76, 1.0f);
    for (int a = 0; a < 3; ++a) header.put(80 + 4 * static_cast<std::size_t>(a), static_cast<float>(g.spacing[a]));
    if (several) header.put(92, frames.times ? static_cast<float>(frames.times->width) : 1.0f);
    if (several && frames.times) header.put(136, static_cast<float>(frames.times->first));
    header.put(108, static_cast<float>(kStart));
    header.put(112, 1.0f); // slope
    const int millimetres = g.worldAxes == WorldAxes::Patient ? 2 : 0;
    header.put(123, static_cast<char>(millimetres + (several && frames.times ? timeCode(frames.times->unit) : 0)));
    const bool isTurned = g.directions != Mat3(1) || g.origin != Vec3(0);
    if (g.worldAxes == WorldAxes::Patient || isTurned) {
        header.put(254, std::int16_t{1});
        for (int row = 0; row < 3; ++row) {
            const std::size_t at = 280 + 16 * static_cast<std::size_t>(row);
            for (int column = 0; column < 3; ++column)
                header.put(at + 4 * static_cast<std::size_t>(column),
                           static_cast<float>(kFlip[row] * g.directions[column][row] * g.spacing[column]));
            header.put(at + 12, static_cast<float>(kFlip[row] * g.origin[row]));
        }
    }
    for (const auto& [at, letter] : {std::pair{344u, 'n'}, {345u, '+'}, {346u, '1'}}) header.put(at, letter);
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

std::vector<std::string> losses(const FramesToWrite& frames, const std::string& path) {
    const Geometry& g = frames.geometry;
    constexpr int kMost = std::numeric_limits<std::int16_t>::max();
    if (std::max({g.dims.x, g.dims.y, g.dims.z, frames.count}) > kMost)
        throw UsageError("NIfTI-1 has at most " + std::to_string(kMost) + " voxels along an axis, and as many frames",
                         path, "choose another format");
    std::vector<std::string> lost;
    bool isExact = true;
    for (int a = 0; a < 3; ++a) isExact = isExact && isFloat(g.spacing[a]) && isFloat(g.origin[a]);
    if (!isExact) lost.emplace_back("NIfTI keeps spacing and origin to seven digits");
    const bool isTurned = g.directions != Mat3(1) || g.origin != Vec3(0);
    if (g.worldAxes == WorldAxes::File && isTurned)
        lost.emplace_back("NIfTI takes every place for one of a patient: the file will be read as such");
    if (!frames.times) return lost;
    if (!isFloat(frames.times->width) || !isFloat(frames.times->first))
        lost.emplace_back("NIfTI keeps times to seven digits");
    if (!frames.times->unit.empty() && timeCode(frames.times->unit) == 0)
        lost.push_back("NIfTI knows no unit of time called " + inQuotes(frames.times->unit));
    return lost;
}

} // namespace

VolumeWriter niftiWriter() { return {"NIfTI", {".nii", ".nii.gz"}, write, losses}; }

} // namespace pellucid
