// flip_bits [--flips N] [--seed S] [--side N] [FILE …]: flips single bits of compressed data, one at a time, and counts
// what reading makes of them: refused in words, all voxels the same (the bit carries no data, such as a date), or other
// values without a word. Without FILEs for one small file of each format. FILEs: .nii.gz, .nrrd with gzip, .mha.
// Exit status: 0 none was read as sound that is not, 1 some were, 2 wrong usage.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "volume/file_contents.h"
#include "volume/flipped_bits.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// A file with what follows `mark`, or all of it, as its compressed data.
PackedFile packedFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    PackedFile file;
    file.bytes.assign(std::istreambuf_iterator<char>(in), {});
    file.format = std::filesystem::path(path).filename().string();
    VolumeSource source;
    source.path = path;
    file.steps = contentsOf(source).steps;
    for (const auto& [suffix, mark] :
         {std::pair{".nii.gz", ""}, {".nrrd", "\n\n"}, {".mha", "ElementDataFile = LOCAL\n"}})
        if (path.ends_with(suffix)) {
            file.suffix = suffix;
            file.begin = file.bytes.find(mark) + std::string(mark).size();
        }
    file.end = file.bytes.size();
    if (file.suffix.empty() || file.begin >= file.end)
        throw UsageError("no compressed data of a known place", path, "give a .nii.gz, .nrrd or .mha");
    return file;
}

} // namespace

int main(int argc, char** argv) {
    int flips = 2000, side = 20;
    std::uint32_t seed = 1;
    std::vector<PackedFile> files;
    try {
        for (int i = 1; i < argc; ++i) {
            const std::string word = argv[i];
            const auto number = [&] { return i + 1 < argc ? std::atoi(argv[++i]) : 0; };
            if (word == "--flips")
                flips = number();
            else if (word == "--seed")
                seed = static_cast<std::uint32_t>(number());
            else if (word == "--side")
                side = number();
            else
                files.push_back(packedFile(word));
        }
        if (flips < 1 || side < 2) throw UsageError("a number is missing or too small", "flip_bits", "");
        if (files.empty()) files = packedFiles(side);
        int wrong = 0;
        std::printf("%-28s %8s %8s %8s %8s\n", "", "flips", "refused", "same", "wrong");
        for (const PackedFile& file : files) {
            BitFlips one(file, seed);
            int counts[3] = {};
            for (int n = 0; n < flips; ++n) ++counts[static_cast<int>(one.next())];
            std::printf("%-28s %8d %8d %8d %8d", file.format.c_str(), flips, counts[0], counts[1], counts[2]);
            std::printf(counts[2] > 0 ? "   such as bit %zu\n" : "\n", one.lastOther());
            std::fflush(stdout);
            wrong += counts[2];
        }
        return wrong > 0 ? 1 : 0;
    } catch (const Error& e) {
        std::fprintf(stderr, "flip_bits: %s\n", e.what());
        return 2;
    }
}
