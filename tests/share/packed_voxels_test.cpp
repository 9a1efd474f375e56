#include "share/packed_voxels.h"

#include <cmath>
#include <random>

#include <catch2/catch.hpp>
#include <zlib.h>

using namespace pellucid;

namespace {

Geometry cells(const Int3& dims) {
    Geometry g;
    g.dims = dims;
    return g;
}

template <class T>
Volume volumeOf(const Int3& dims, std::vector<T> values, std::optional<double> missing = {}) {
    return Volume(cells(dims), Samples(SampleArray<T>(std::move(values))), missing);
}

} // namespace

TEST_CASE("codes are exact where integers fit", "[share]") {
    const Volume bytes = volumeOf<std::uint8_t>({3, 1, 1}, {10, 20, 110});
    const ShareCodes narrow = shareCodes(bytes, 0);
    CHECK((narrow.bits == 8 && narrow.maxCode == 100 && narrow.exact)); // 110 − 10
    CHECK(voxelPlanes(bytes, narrow) == std::vector<unsigned char>{0, 10, 100});

    const Volume ct = volumeOf<std::int16_t>({3, 1, 1}, {-1024, 0, 2986});
    const ShareCodes wide = shareCodes(ct, 0);
    CHECK((wide.bits == 16 && wide.maxCode == 4010 && wide.exact));
    CHECK(wide.largestError() == 0);
    // 1024 = 4·256 and 4010 = 15·256 + 170: the high bytes, then the low ones.
    CHECK(voxelPlanes(ct, wide) == std::vector<unsigned char>{0, 4, 15, 0, 0, 170});

    const ShareCodes rounded = shareCodes(ct, 8);
    CHECK((rounded.bits == 8 && rounded.maxCode == 255 && !rounded.exact));
    CHECK(rounded.largestError() == Approx(0.5 / 255));
    CHECK(voxelPlanes(ct, rounded) == std::vector<unsigned char>{0, 65, 255}); // 1024·255/4010 = 65.1
}

TEST_CASE("what is no whole number has the finest codes there are", "[share]") {
    const Volume floats = volumeOf<float>({2, 1, 1}, {0.25f, 0.75f});
    const ShareCodes codes = shareCodes(floats, 0);
    CHECK((codes.bits == 16 && codes.maxCode == 65535 && !codes.exact));
    CHECK(voxelPlanes(floats, codes) == std::vector<unsigned char>{0, 255, 0, 255});
    CHECK(shareCodes(volumeOf<float>({2, 1, 1}, {4.0f, 4.0f}), 0).largestError() == 0);
}

TEST_CASE("invalid voxels have a plane of their own", "[share]") {
    const Volume some = volumeOf<std::uint8_t>({4, 1, 1}, {0, 99, 5, 10}, 99.0);
    CHECK(voxelPlanes(some, shareCodes(some, 0)) == std::vector<unsigned char>{0, 0, 5, 10, 1, 0, 1, 1});
}

TEST_CASE("packed voxels are what any zlib unpacks", "[share]") {
    std::vector<unsigned char> bytes(3'000'000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>((i * i >> 7) & 31);
    const std::vector<unsigned char> packed = deflated(bytes);
    CHECK(packed.size() < bytes.size());
    std::vector<unsigned char> back(bytes.size());
    uLongf size = back.size();
    REQUIRE(uncompress(back.data(), &size, packed.data(), packed.size()) == Z_OK);
    CHECK((size == bytes.size() && back == bytes));
    CHECK(!deflated({}).empty());

    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(deflated(bytes, {stop.get_token(), {}}), Cancelled);
}

TEST_CASE("some layers tell how well a volume packs", "[share]") {
    std::vector<std::uint8_t> values(40 * 40 * 40);
    std::minstd_rand noise32(7);
    for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(noise32() >> 25);
    values[0] = 0;
    const Volume noise = volumeOf<std::uint8_t>({40, 40, 40}, values);
    const ShareCodes codes = shareCodes(noise, 0);
    const double all = static_cast<double>(deflated(voxelPlanes(noise, codes)).size()) / 64000;
    CHECK(packedBytesPerVoxel(noise, codes) == Approx(all).epsilon(0.05));
}
