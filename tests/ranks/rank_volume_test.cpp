// What is found out of a volume block by block is what is found out of all of it.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "ranks/rank_volume.h"
#include "saliency/saliency_field.h"
#include "support/random_cases.h"
#include "support/temp_folder.h"
#include "support/thread_ranks.h"
#include "volume/excerpt.h"
#include "volume/histogram.h"
#include "volume/loader.h"
#include "volume/voxel_survey.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// `volume` on each of so many ranks: body(the rank's volume). Saliency reaches 4 voxels at most.
template <class Body>
void onBlocksOf(const std::shared_ptr<const Volume>& volume, int count, const Body& body) {
    const Decomposition blocks(volume->dims(), count);
    onRanks(count, [&](Communicator& ranks) {
        body(ranks, volumeOfBlocks(ranks, blockOf(volume, blocks, ranks.rank(), Int3(4)), *volume));
    });
}

} // namespace

TEST_CASE("a volume of blocks has range, counts, histogram, survey and coarser copies of the whole", "[ranks]") {
    for (const std::uint32_t number : {1u, 4u, 7u, 13u}) {
        const RandomCase c = randomCase(number, 1.5);
        INFO(c.describe());
        const Histogram histogram = makeHistogram(*c.volume);
        const VoxelSurvey survey = surveyVoxels(*c.volume);
        const auto ends = boundaryEnds(*c.volume, survey, 0, 1e-6);
        const Volume coarse = coarserCopy(*c.volume, 3);
        onBlocksOf(c.volume, 5, [&](Communicator& ranks, const Volume& v) {
            const Histogram counts = makeHistogram(v);
            const VoxelSurvey sample = surveyVoxels(v);
            const auto paths = boundaryEnds(v, sample, 0, 1e-6);
            const Volume small = coarserCopy(v, 3);
            if (ranks.rank() != 2) return;
            CHECK(v.dataRange() == c.volume->dataRange());
            CHECK(v.invalidCount() == c.volume->invalidCount());
            CHECK(v.sampleType() == c.volume->sampleType());
            CHECK(v.geometry().dims == c.volume->dims());
            CHECK(counts.counts == histogram.counts);
            CHECK(counts.codes == histogram.codes);
            bool same = true;
            for (std::size_t i = 0; i < survey.size(); ++i) {
                same &= survey.values[i] == sample.values[i] ||
                        (std::isnan(survey.values[i]) && std::isnan(sample.values[i]));
                same &= survey.gradients[i] == sample.gradients[i] ||
                        (std::isnan(survey.gradients[i]) && std::isnan(sample.gradients[i]));
            }
            CHECK(same);
            REQUIRE(paths.size() == ends.size());
            for (std::size_t i = 0; i < ends.size(); ++i) {
                same &= paths[i].low == ends[i].low || std::isnan(ends[i].low);
                same &= paths[i].high == ends[i].high || std::isnan(ends[i].high);
            }
            CHECK(same);
            REQUIRE(small.size() == coarse.size());
            double most = 0; // sums of floats in another order
            for (std::size_t i = 0; i < coarse.size(); ++i)
                if (coarse.isValid(i)) most = std::max(most, std::abs(coarse.value(i) - small.value(i)));
            CHECK(most <= 1e-6 * std::max(std::abs(coarse.dataRange().lo), std::abs(coarse.dataRange().hi)));
        });
    }
}

TEST_CASE("the weights of a block are those of the whole", "[ranks]") {
    const RandomCase c = randomCase(5, 1.5);
    const WeightFields weights = saliencyFields(*c.volume, c.tf);
    onBlocksOf(c.volume, 4, [&](Communicator&, const Volume& v) {
        const WeightFields own = saliencyFields(v, c.tf);
        if (v.here() == nullptr) return;
        const VoxelRegion block = v.elsewhere()->own(), stored = v.elsewhere()->stored();
        REQUIRE(own.dims() == stored.hi - stored.lo);
        double most = 0;
        for (int k = block.lo.z; k < block.hi.z; ++k)
            for (int j = block.lo.y; j < block.hi.y; ++j)
                for (int i = block.lo.x; i < block.hi.x; ++i) {
                    const std::size_t here = voxelIndex(own.dims(), i - stored.lo.x, j - stored.lo.y, k - stored.lo.z),
                                      there = voxelIndex(c.volume->dims(), i, j, k);
                    for (const int a : {0, 1})
                        most = std::max(most, static_cast<double>(std::abs(own.at(a, here) - weights.at(a, there))));
                }
        CHECK(most < 5e-5); // two units of what is stored
    });
}

TEST_CASE("who asks for all voxels at once is told where they are", "[ranks]") {
    const RandomCase c = randomCase(2, 1.5);
    onBlocksOf(c.volume, 2, [&](Communicator&, const Volume& v) {
        CHECK_THROWS_WITH(v.samples(), Catch::Contains("the voxels lie on several ranks"));
        CHECK_THROWS_AS(v.value(0), Error);
    });
}

TEST_CASE("saliency that reaches beyond what is around a block is refused", "[ranks]") {
    const RandomCase c = randomCase(2, 2);
    onBlocksOf(c.volume, 2, [&](Communicator&, const Volume& v) {
        SaliencyOptions wide;
        wide.sigma = 8;
        CHECK_THROWS_WITH(saliencyFields(v, c.tf, wide), Catch::Contains("saliency reaches further"));
    });
}

TEST_CASE("each rank reads its block of a file, and a broken file is an error of all", "[ranks]") {
    const TempFolder folder;
    const Int3 dims(40, 36, 33);
    std::vector<std::int16_t> values(voxelCount(dims));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int16_t>(i * 7919 % 20011);
    const std::string path = folder.path("v.raw");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * 2));
    VolumeSource source;
    source.path = path;
    source.raw = RawLayout{};
    source.raw->dims = dims;
    source.raw->type = SampleType::I16;
    RankLayout layout;
    layout.smallest = 1; // few as they are
    const Volume whole = loadHere(source);
    onRanks(3, [&](Communicator& ranks) {
        const Volume v = loadOnRanks(ranks, source, layout);
        REQUIRE(v.here() != nullptr);
        CHECK(v.dataRange() == whole.dataRange());
        CHECK(v.geometry().origin == whole.geometry().origin);
        const VoxelRegion stored = v.elsewhere()->stored();
        CHECK(voxelCount(stored.hi - stored.lo) < whole.size());
        bool same = true;
        for (int k = stored.lo.z; k < stored.hi.z; ++k)
            for (int j = stored.lo.y; j < stored.hi.y; ++j)
                for (int i = stored.lo.x; i < stored.hi.x; ++i)
                    same &= v.here()->value(voxelIndex(v.here()->dims(), i - stored.lo.x, j - stored.lo.y,
                                                       k - stored.lo.z)) == whole.value(voxelIndex(dims, i, j, k));
        CHECK(same);
    });
    // How the data lie, as the user has it, is the same for all blocks.
    source.axes = parseGridAxes("-z+x-y");
    source.spacing = GridSpacing{{0.5, 1, 2}, LengthUnit::Micrometre};
    const Geometry placed = loadHere(source).geometry();
    onRanks(3, [&](Communicator& ranks) {
        const Geometry own = loadOnRanks(ranks, source, layout).geometry();
        CHECK(own.dims == placed.dims);
        CHECK(own.directions == placed.directions);
        CHECK(own.spacing == placed.spacing);
        CHECK(own.lengthUnit == placed.lengthUnit);
        CHECK(glm::distance(own.origin, placed.origin) < 1e-9);
    });
    source.raw->dims.z = 34;
    CHECK_THROWS_AS(onRanks(3, [&](Communicator& ranks) { loadOnRanks(ranks, source, layout); }), FileError);
}

namespace {

/// A .pvti of 2 × 2 × 2 pieces that share planes, each a .vti of its own, and one .vti of the same. The value of a
/// point is its number, in a circle.
struct PiecesAndWhole {
    TempFolder folder;
    std::string pieces, whole;
};

std::string valuesAsText(const Int3& lo, const Int3& hi, const Int3& dims) {
    std::string text;
    for (int k = lo.z; k <= hi.z; ++k)
        for (int j = lo.y; j <= hi.y; ++j)
            for (int i = lo.x; i <= hi.x; ++i) text += std::to_string(voxelIndex(dims, i, j, k) * 7919 % 20011) + " ";
    return text;
}

void writePieces(PiecesAndWhole& files, const Int3& dims) {
    const auto image = [&](const std::string& name, const Int3& lo, const Int3& hi) {
        std::string extent;
        for (int a = 0; a < 3; ++a) extent += std::to_string(lo[a]) + " " + std::to_string(hi[a]) + " ";
        files.folder.write(name,
                           "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"" + extent + "\"><Piece Extent=\"" +
                               extent + "\"><PointData><DataArray type=\"Int16\" Name=\"v\" format=\"ascii\">" +
                               valuesAsText(lo, hi, dims) + "</DataArray></PointData></Piece></ImageData></VTKFile>");
        return extent;
    };
    std::string text = "<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"" +
                       image("whole.vti", Int3(0), dims - 1) +
                       "\"><PPointData><PDataArray type=\"Int16\" Name=\"v\"/></PPointData>";
    for (int n = 0; n < 8; ++n) {
        Int3 lo(0), hi = dims - 1;
        for (int a = 0; a < 3; ++a) ((n >> a & 1) == 0 ? hi : lo)[a] = dims[a] / 3;
        const std::string name = "piece" + std::to_string(n) + ".vti";
        text += "<Piece Extent=\"" + image(name, lo, hi) + "\" Source=\"" + name + "\"/>";
    }
    files.pieces = files.folder.write("a.pvti", text + "</PImageData></VTKFile>");
    files.whole = files.folder.path("whole.vti");
}

} // namespace

TEST_CASE("an image in pieces lies on ranks as the same image in one file", "[ranks]") {
    const Int3 dims(26, 24, 22);
    PiecesAndWhole files;
    writePieces(files, dims);
    VolumeSource source;
    source.path = files.whole;
    const Volume whole = loadHere(source);
    const Histogram histogram = makeHistogram(whole);
    source.path = files.pieces;
    for (const int count : {2, 3, 4}) {
        CAPTURE(count);
        std::vector<int> voxels(static_cast<std::size_t>(count)), figures = voxels, parts = voxels;
        onRanks(count, [&](Communicator& ranks) {
            const auto rank = static_cast<std::size_t>(ranks.rank());
            RankLayout layout{.smallest = 1};
            const Volume v = loadOnRanks(ranks, source, layout);
            const Histogram counts = makeHistogram(v);
            figures[rank] = v.dataRange() == whole.dataRange() && v.dims() == dims &&
                            v.geometry().origin == whole.geometry().origin && counts.counts == histogram.counts &&
                            counts.codes == histogram.codes;
            const VoxelRegion stored = v.elsewhere()->stored();
            parts[rank] = voxelCount(stored.hi - stored.lo) < whole.size();
            bool same = v.here() != nullptr;
            for (int k = stored.lo.z; same && k < stored.hi.z; ++k)
                for (int j = stored.lo.y; j < stored.hi.y; ++j)
                    for (int i = stored.lo.x; i < stored.hi.x; ++i) {
                        const Int3 at = Int3(i, j, k) - stored.lo;
                        same &= v.here()->value(voxelIndex(v.here()->dims(), at.x, at.y, at.z)) ==
                                whole.value(voxelIndex(dims, i, j, k));
                    }
            voxels[rank] = same;
        });
        const std::vector<int> all(static_cast<std::size_t>(count), 1);
        CHECK(voxels == all);
        CHECK(figures == all);
        CHECK(parts == all);
    }
    // The last piece is missing: the rank that needs it says so, and all throw.
    std::filesystem::remove(files.folder.path("piece7.vti"));
    std::array<int, 2> failed{};
    onRanks(2, [&](Communicator& ranks) {
        try {
            RankLayout layout{.smallest = 1};
            loadOnRanks(ranks, source, layout);
        } catch (const FileError& e) {
            failed[static_cast<std::size_t>(ranks.rank())] = e.where() == files.folder.path("piece7.vti");
        }
    });
    CHECK(failed == std::array<int, 2>{1, 1});
}

TEST_CASE("where one rank cannot read its block all say so, and stay in step", "[ranks]") {
    // Noise packs badly: of the first two thirds of the file rank 0 finds its half of the slices.
    std::mt19937 random(7);
    std::vector<std::uint8_t> noise(std::size_t{40} * 40 * 64);
    for (std::uint8_t& v : noise) v = static_cast<std::uint8_t>(random());
    Geometry geometry;
    geometry.dims = {40, 40, 64};
    const TempFolder folder;
    const std::string path = folder.path("noise.nrrd");
    writeNrrd(Volume(geometry, SampleArray<std::uint8_t>(noise)), path);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
    VolumeSource source;
    source.path = path;
    std::array<int, 2> failed{}, agreed{};
    onRanks(2, [&](Communicator& ranks) {
        const auto rank = static_cast<std::size_t>(ranks.rank());
        try {
            RankLayout layout{.smallest = 1};
            loadOnRanks(ranks, source, layout);
        } catch (const Error&) {
            failed[rank] = 1;
        }
        // What comes next is the same for both.
        agreed[rank] = gatherValues(ranks, 10 + ranks.rank()) == std::vector<int>{10, 11};
    });
    CHECK(failed == std::array<int, 2>{1, 1});
    CHECK(agreed == std::array<int, 2>{1, 1});
}
