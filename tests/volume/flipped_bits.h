// Compressed files in each format, and what becomes of them when one bit of the compressed data is flipped.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "packers.h"
#include "support/temp_folder.h"
#include "volume/loader.h"
#include "volume_files.h"
#include "vtk_files.h"

namespace pellucid::test {

/// A file whose bytes [begin, end) are compressed data.
struct PackedFile {
    std::string format; ///< for people
    std::string suffix, bytes;
    std::size_t begin = 0, end = 0;
    int steps = 1;                              ///< time steps, each of which is read alone
    std::string headerSuffix = "", header = ""; ///< beside it, where it has no header of its own: "DATA" is its name
    std::string raw = "";                       ///< how it is laid out, where it has none at all
};

/// What reading a damaged file has come to.
enum class Reading {
    Refused, ///< in words
    Same,    ///< all voxels are those of the undamaged file
    Other    ///< they are not, and nothing was said
};

/// Voxels of 16 bits, `side` along each axis, for so many steps: waves and a little noise, as measured data have them.
inline std::string wavesAndNoise(int side, int steps) {
    std::vector<std::int16_t> values;
    std::mt19937 random(7);
    for (int step = 0; step < steps; ++step)
        for (int k = 0; k < side; ++k)
            for (int j = 0; j < side; ++j)
                for (int i = 0; i < side; ++i)
                    values.push_back(static_cast<std::int16_t>(900 * std::sin(0.3 * i + step) * std::cos(0.2 * j) +
                                                               20 * k + static_cast<int>(random() % 16)));
    return bytesOf(values);
}

/// One file for each way in which a format has compressed data.
inline std::vector<PackedFile> packedFiles(int side) {
    constexpr int kSteps = 4;
    const std::string one = wavesAndNoise(side, 1), four = wavesAndNoise(side, kSteps);
    const std::string text = std::to_string(side), sizes = text + " " + text + " " + text;
    std::vector<PackedFile> files;
    const auto add = [&](const std::string& format, const std::string& suffix, const std::string& before,
                         const std::string& packed, int steps = 1, const std::string& after = "") {
        files.push_back({format, suffix, before + packed + after, before.size(), before.size() + packed.size(), steps});
    };
    Nifti nifti;
    const auto size = static_cast<std::int16_t>(side);
    nifti.dim = {3, size, size, size, 1, 1, 1, 1};
    nifti.datatype = 4;
    nifti.bitpix = 16;
    add("NIfTI gzip", ".nii.gz", "", gzipped(nifti.header() + one));
    nifti.dim[0] = 4;
    nifti.dim[4] = kSteps;
    const std::string whole = nifti.header() + four;
    add("NIfTI gzip, steps", ".nii.gz", "", gzipped(whole), kSteps);
    // Members that end within a step, as programs write them that pack in parallel.
    std::string members;
    for (std::size_t at = 0, each = whole.size() / 7; at < whole.size(); at += each)
        members += gzipped(whole.substr(at, each));
    add("NIfTI gzip, members", ".nii.gz", "", members, kSteps);

    const std::string nrrd = "NRRD0004\ntype: short\nendian: little\nencoding: gzip\ndimension: ";
    add("NRRD gzip", ".nrrd", nrrd + "3\nsizes: " + sizes + "\n\n", gzipped(one));
    add("NRRD gzip, steps", ".nrrd", nrrd + "4\nsizes: " + sizes + " 4\n\n", gzipped(four), kSteps);
    add("NRRD gzip, data at the end", ".nrrd", nrrd + "3\nsizes: " + sizes + "\nbyte skip: -1\n\n",
        gzipped("something else before it" + one.substr(0, 1000)) + gzipped(one.substr(1000)));
    add("NRRD gzip, detached", ".raw.gz", "", gzipped(one));
    files.back().headerSuffix = ".nhdr";
    files.back().header = nrrd + "3\nsizes: " + sizes + "\ndata file: DATA\n";
    const std::string bzip2 = "NRRD0004\ntype: short\nendian: little\nencoding: bzip2\ndimension: ";
    add("NRRD bzip2", ".nrrd", bzip2 + "3\nsizes: " + sizes + "\n\n", bzipped(one));
    add("NRRD bzip2, steps", ".nrrd", bzip2 + "4\nsizes: " + sizes + " 4\n\n",
        bzipped(four.substr(0, 5000)) + bzipped(four.substr(5000)), kSteps);
    add("raw gzip", ".raw.gz", "", gzipped(one));
    files.back().raw = text + "," + text + "," + text + ",i16";
    add("NRRD gzip, list of files", ".raw.gz", "", gzipped(one));
    files.back().headerSuffix = ".nhdr";
    files.back().header = nrrd + "3\nsizes: " + sizes + "\ndata file: LIST 3\nDATA\n";

    const std::string meta = "ObjectType = Image\nElementType = MET_SHORT\nCompressedData = True\n";
    const std::string local = "\nElementDataFile = LOCAL\n";
    add("MetaImage zlib", ".mha", meta + "NDims = 3\nDimSize = " + sizes + local, zlibbed(one));
    add("MetaImage zlib, steps", ".mha", meta + "NDims = 4\nDimSize = " + sizes + " 4" + local, zlibbed(four), kSteps);
    add("MetaImage zlib, detached", ".zraw", "", zlibbed(one));
    files.back().headerSuffix = ".mhd";
    files.back().header = meta + "NDims = 3\nDimSize = " + sizes + "\nElementDataFile = DATA\n";

    const std::string last = std::to_string(side - 1), extent = "0 " + last + " 0 " + last + " 0 " + last;
    using Place = Style::Place;
    for (const auto& [place, how] :
         {std::pair{Place::Raw, "raw"}, {Place::Base64, "base64"}, {Place::Inline, "inline"}})
        for (const std::size_t block : {one.size(), std::size_t{1} << 12}) {
            const Style style{place, true, false, false, block};
            const std::string packed = stored(style, one);
            const std::string file =
                vti(style, {{"type=\"Int16\" Name=\"a\"", "", one}}, "", "WholeExtent=\"" + extent + "\"", extent);
            const std::size_t begin = file.find(packed);
            add(std::string("VTK zlib, ") + how + (block == one.size() ? ", one block" : ", blocks"), ".vti",
                file.substr(0, begin), packed, 1, file.substr(begin + packed.size()));
        }
    Style lzma{Place::Raw, true, false, false, std::size_t{1} << 12, Style::Packer::Lzma};
    const std::string xz = stored(lzma, one);
    const std::string ofLzma =
        vti(lzma, {{"type=\"Int16\" Name=\"a\"", "", one}}, "", "WholeExtent=\"" + extent + "\"", extent);
    const std::size_t xzBegin = ofLzma.find(xz);
    add("VTK LZMA, blocks", ".vti", ofLzma.substr(0, xzBegin), xz, 1, ofLzma.substr(xzBegin + xz.size()));
    // Halves that share a layer.
    const Style style{Place::Raw, true, false, false, std::size_t{1} << 12};
    const std::size_t half = static_cast<std::size_t>(side) / 2, layer = one.size() / static_cast<std::size_t>(side);
    const std::string across = "0 " + last + " 0 " + last + " ", middle = std::to_string(half);
    const std::string low = one.substr(0, layer * (half + 1)), high = one.substr(layer * half);
    const std::string pieces = vtiOfPieces(style,
                                           {{across + "0 " + middle, {{"type=\"Int16\" Name=\"a\"", "", low}}},
                                            {across + middle + " " + last, {{"type=\"Int16\" Name=\"a\"", "", high}}}},
                                           "", "WholeExtent=\"" + extent + "\"");
    const std::string packed = stored(style, low) + stored(style, high);
    const std::size_t begin = pieces.find(packed);
    add("VTK zlib, pieces", ".vti", pieces.substr(0, begin), packed, 1, pieces.substr(begin + packed.size()));
    return files;
}

/// Flips bits of one file, one at a time.
class BitFlips {
public:
    BitFlips(PackedFile file, std::uint32_t seed) : m_file(std::move(file)), m_random(seed) {
        for (int step = 0; step < m_file.steps; ++step) m_sound.push_back(read(m_file.bytes, step).samples());
    }

    /// Flips one bit, anywhere in the compressed data, and reads one of the steps. The same seed, the same bits.
    Reading next() {
        const std::size_t bit = 8 * m_file.begin + m_random() % (8 * (m_file.end - m_file.begin));
        const int step = static_cast<int>(m_random() % static_cast<std::uint64_t>(m_file.steps));
        std::string bytes = m_file.bytes;
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
        try {
            const Volume volume = read(bytes, step);
            if (volume.samples() == m_sound[static_cast<std::size_t>(step)]) return Reading::Same;
            m_lastOther = bit;
            return Reading::Other;
        } catch (const FileError&) {
            return Reading::Refused;
        }
    }
    /// Of the last one that was Other; bit 0 is the lowest of the file's first byte.
    std::size_t lastOther() const { return m_lastOther; }

private:
    /// Each time a file of another name: what is known of one that has been read does not count.
    Volume read(const std::string& bytes, int step) {
        const std::string name = "f" + std::to_string(m_files++), data = name + m_file.suffix;
        VolumeSource source;
        source.path = m_folder.write(data, bytes);
        source.step = step;
        if (!m_file.raw.empty()) source.raw = parseRawLayout(m_file.raw);
        if (!m_file.header.empty()) {
            std::string header = m_file.header;
            source.path = m_folder.write(name + m_file.headerSuffix, header.replace(header.find("DATA"), 4, data));
        }
        struct Gone {
            std::vector<std::string> paths;
            ~Gone() {
                std::error_code ec;
                for (const std::string& path : paths) std::filesystem::remove(path, ec);
            }
        } const gone{{source.path, m_folder.path(data)}};
        return loadVolume(source);
    }

    PackedFile m_file;
    std::mt19937_64 m_random;
    TempFolder m_folder;
    std::vector<Samples> m_sound;
    std::size_t m_files = 0, m_lastOther = 0;
};

} // namespace pellucid::test
