// Writes NIfTI-1 in one file, plain or packed by gzip. The grid is placed by sform.
#include <array>
#include <cmath>
#include <cstring>

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

Header headerOf(const Volume& volume) {
    struct Type {
        std::int16_t code, bits;
    };
    constexpr Type kTypes[] = {{2, 8}, {256, 8}, {512, 16}, {4, 16}, {768, 32}, {8, 32}, {16, 32}, {64, 64}};
    const Geometry& g = volume.geometry();
    const Type type = kTypes[static_cast<std::size_t>(volume.sampleType())];
    Header header;
    header.put(0, static_cast<std::int32_t>(kHeader));
    header.put(40, std::int16_t{3});
    for (int a = 0; a < 7; ++a)
        header.put(42 + 2 * static_cast<std::size_t>(a), static_cast<std::int16_t>(a < 3 ? g.dims[a] : 1));
    header.put(70, type.code);
    header.put(72, type.bits);
    header.put(76, 1.0f);
    for (int a = 0; a < 3; ++a) header.put(80 + 4 * static_cast<std::size_t>(a), static_cast<float>(g.spacing[a]));
    header.put(108, static_cast<float>(kStart));
    header.put(112, 1.0f);                                                         // slope
    header.put(123, static_cast<char>(g.worldAxes == WorldAxes::Patient ? 2 : 0)); // mm
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

void write(const Volume& volume, const std::string& path, const JobControl& job) {
    const Header header = headerOf(volume);
    const auto first = std::as_bytes(std::span(header.bytes()));
    writeAtomically(path, [&](OutputFile& out) {
        if (!lowerCase(path).ends_with(".gz")) {
            out.write(header.bytes().data(), header.bytes().size());
            return writePieces(out, sampleBytes(volume), job);
        }
        deflatePieces(out, {first, sampleBytes(volume)}, job);
    });
}

std::vector<std::string> losses(const Geometry& g) {
    std::vector<std::string> lost;
    bool isExact = true;
    for (int a = 0; a < 3; ++a)
        isExact = isExact && static_cast<double>(static_cast<float>(g.spacing[a])) == g.spacing[a] &&
                  static_cast<double>(static_cast<float>(g.origin[a])) == g.origin[a];
    if (!isExact) lost.emplace_back("NIfTI keeps spacing and origin to seven digits");
    const bool isTurned = g.directions != Mat3(1) || g.origin != Vec3(0);
    if (g.worldAxes == WorldAxes::File && isTurned)
        lost.emplace_back("NIfTI takes every place for one of a patient: the file will be read as such");
    return lost;
}

} // namespace

VolumeWriter niftiWriter() { return {"NIfTI", {".nii", ".nii.gz"}, write, losses}; }

} // namespace pellucid
